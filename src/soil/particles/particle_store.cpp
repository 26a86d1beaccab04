// SPDX-License-Identifier: Apache-2.0
#include "soil/particles/particle_store.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <numeric>
#include <span>
#include <utility>

#include "core/archive.h"
#include "soil/particles/buffers.h"

namespace navvy::soil {
namespace {

/// Runs of blocks begin at full packs, so that sixteen lanes never belong to two blocks.
int padded(int count) { return (count + NAVVY_LANES - 1) / NAVVY_LANES * NAVVY_LANES; }

/// Sets a particle's block to that of its base node floor(x - 0.5).
void find_particle_block(Particle& p) {
  for (int a = 0; a < 3; ++a) {
    const int base = static_cast<int>(std::floor(p.x[a] - 0.5f));
    const int d = base >= 0 ? base / kBlockCells : -((-base + kBlockCells - 1) / kBlockCells);
    p.block[a] += d;
    p.x[a] -= static_cast<float>(kBlockCells * d);
  }
}

BlockKey key_of(const Particle& p) { return {p.block[0], p.block[1], p.block[2]}; }

/// Returns the cell of the base node inside its block, x fastest.
int cell_of(const Particle& p) {
  int cell = 0;
  // Bounded as in the kernels: a particle that came from another block may have been rounded up.
  for (int a = 2; a >= 0; --a)
    cell = kBlockCells * cell +
           std::clamp(static_cast<int>(std::floor(p.x[a] - 0.5f)), 0, kBlockCells - 1);
  return cell;
}

// Particle and store have the fields of one list: if one lacks a field, this does not compile.
void put_record(const Particle& p, float* state, std::size_t capacity, std::size_t slot) {
  float* words = state + slot;
#define PUT_ONE(NAME, member, rest) words[FIELD_##NAME * capacity] = p.member;
#define PUT_MANY(NAME, member, count, rest) \
  for (std::size_t k = 0; k < (count); ++k) words[(FIELD_##NAME + k) * capacity] = p.member[k];
  FLOAT_FIELDS(PUT_ONE, PUT_MANY)
#undef PUT_ONE
#undef PUT_MANY
  // Integers are stored as bits: a state is one array of 32-bit words.
  words[FIELD_MASS * capacity] = std::bit_cast<float>(p.mass);
  words[FIELD_TAG * capacity] = std::bit_cast<float>(static_cast<std::int32_t>(p.soil) |
                                                     static_cast<std::int32_t>(p.side) << 16);
  words[FIELD_ID * capacity] = std::bit_cast<float>(p.id);
}

/// Reads back the integers that put_record wrote: `each(field, set)` calls set(particle, word) for
/// all particles.
template <class Each>
void get_integers(const Each& each) {
  each(FIELD_MASS, [](Particle& p, float w) { p.mass = std::bit_cast<std::int32_t>(w); });
  each(FIELD_TAG, [](Particle& p, float w) {
    const auto tag = std::bit_cast<std::uint32_t>(w);
    p.soil = static_cast<std::uint16_t>(tag & 0xffff);
    p.side = static_cast<std::uint16_t>(tag >> 16);
  });
  each(FIELD_ID, [](Particle& p, float w) { p.id = std::bit_cast<std::uint32_t>(w); });
}

/// Reads back what put_record wrote in consecutive slots, from `words` on. Fields are read one
/// after another: the fields of one particle lie far apart in memory. Blocks are not in the words:
/// the caller sets them.
void get_records(const float* words, std::size_t capacity, std::span<Particle> out) {
  const auto each = [&](std::size_t field, const auto& set) {
    const float* from = words + field * capacity;
    for (std::size_t i = 0; i < out.size(); ++i) set(out[i], from[i]);
  };
#define GET_ONE(NAME, member, rest) each(FIELD_##NAME, [](Particle& p, float w) { p.member = w; });
#define GET_MANY(NAME, member, count, rest) \
  for (std::size_t k = 0; k < (count); ++k) \
    each(FIELD_##NAME + k, [k](Particle& p, float w) { p.member[k] = w; });
  FLOAT_FIELDS(GET_ONE, GET_MANY)
#undef GET_ONE
#undef GET_MANY
  get_integers(each);
}

/// Returns the number of slots that runs of these counts need, with padding.
int slots_of(const std::vector<int>& counts) {
  return std::accumulate(counts.begin(), counts.end(), 0,
                         [](int sum, int count) { return sum + padded(count); });
}

/// Returns the values of a lane without a particle, from particle_fields.h.
Particle empty_lane() {
  Particle p;
#define REST_ONE(NAME, member, rest) p.member = rest;
#define REST_MANY(NAME, member, count, rest) \
  std::fill(std::begin(p.member), std::end(p.member), rest);
  FLOAT_FIELDS(REST_ONE, REST_MANY)
#undef REST_ONE
#undef REST_MANY
  return p;
}

/// Returns particles, in the order of `sorted`, as a re-bin adds them.
AddedParticles added_particles(const std::vector<Particle>& sorted) {
  AddedParticles out;
  out.words.resize(FIELD_COUNT * sorted.size());
  for (const Particle& p : sorted) {
    if (out.keys.empty() || !(out.keys.back() == key_of(p))) {
      out.keys.push_back(key_of(p));
      out.counts.push_back(0);
    }
    ++out.counts.back();
    put_record(p, out.words.data(), sorted.size(), out.cells.size());
    out.cells.push_back(static_cast<std::uint8_t>(cell_of(p)));
  }
  return out;
}

/// No site has blocks beyond this: a side has at most 2^30 columns.
constexpr std::int32_t kFarthestBlock = (1 << 30) / kBlockCells;
/// A site that no particle leaves.
constexpr std::array<std::int32_t, 4> kEverywhere = {-(1 << 30), -(1 << 30), 1 << 30, 1 << 30};

/// Particles of one block as they are hashed and saved: words as on the device, field after field.
/// They are not copied, which alone would take a quarter of the hashing time.
class BlockWords {
 public:
  void visit(Archive& a) {
    a("block", block);
    for (std::size_t f = 0; f < FIELD_COUNT; ++f)
      a.item(f, [&] { a.loading() ? a("words", loaded_[f]) : a("words", fields_[f]); });
  }
  BlockKey key() const { return {block[0], block[1], block[2]}; }
  /// Refers to `count` particles whose fields lie `capacity` words apart from `first` on, which
  /// must outlive the visit.
  void take(const float* first, std::size_t capacity, std::size_t count) {
    for (std::size_t f = 0; f < FIELD_COUNT; ++f) fields_[f] = {first + f * capacity, count};
  }
  /// Refers to particles of one block on the host.
  void take(std::span<const Particle> particles);
  /// Appends the particles that were loaded, after checks.
  void give(Archive& a, std::vector<Particle>& particles, std::size_t soils);

  std::array<std::int32_t, 3> block{};

 private:
  std::array<std::span<const float>, FIELD_COUNT> fields_;
  std::array<std::vector<float>, FIELD_COUNT> loaded_;
  // Words of particles on the host.
  std::vector<float> words_;
};

void BlockWords::take(std::span<const Particle> particles) {
  std::copy(std::begin(particles.front().block), std::end(particles.front().block), block.begin());
  words_.resize(FIELD_COUNT * particles.size());
  for (std::size_t i = 0; i < particles.size(); ++i)
    put_record(particles[i], words_.data(), particles.size(), i);
  take(words_.data(), particles.size(), particles.size());
}

// Values that are not finite are accepted: the snapshot of a run that failed shows where it did.
void BlockWords::give(Archive& a, std::vector<Particle>& particles, std::size_t soils) {
  const auto near = [](std::int32_t b) { return b >= -kFarthestBlock && b <= kFarthestBlock; };
  a.require(std::all_of(block.begin(), block.end(), near), "block", "lies off any site");
  const std::size_t count = loaded_[0].size();
  words_.clear();
  for (const std::vector<float>& field : loaded_) {
    a.require(count > 0 && field.size() == count, "words",
              "must be those of as many particles in every field");
    words_.insert(words_.end(), field.begin(), field.end());
  }
  particles.resize(particles.size() + count);
  const std::span<Particle> added = std::span(particles).last(count);
  get_records(words_.data(), count, added);
  for (Particle& p : added) {
    std::copy(block.begin(), block.end(), std::begin(p.block));
    a.require(p.soil < soils, "words", "a particle is of a soil that the scene does not have");
  }
}

}  // namespace

ParticleStore::ParticleStore(device::Device& device, const std::array<std::int32_t, 4>& site,
                             const std::vector<SoilRow>& soils)
    : device_(device), site_(site), rebin_(device), soils_(device, soils), soil_rows_(soils) {
  assign({});
}

// Block h begins where the previous one ends, padded. Without tools every block has one tile, of
// its own index.
void ParticleStore::assign_slots(const std::vector<int>& counts) {
  particle_blocks_.assign(table_.particle_blocks.size(), ParticleBlock{});
  int slot = 0;
  for (std::size_t h = 0; h < particle_blocks_.size(); ++h) {
    particle_blocks_[h].start = slot;
    particle_blocks_[h].count = counts[h];
    particle_blocks_[h].tile = static_cast<int>(h);
    slot += padded(counts[h]);
  }
  count_ = std::accumulate(counts.begin(), counts.end(), 0);
}

void ParticleStore::upload_particle_blocks() {
  particle_blocks_buffer_.write(particle_blocks_);
  std::vector<std::array<std::int32_t, 4>> keys(particle_blocks_.size());
  for (std::size_t h = 0; h < keys.size(); ++h)
    keys[h] = {table_.particle_blocks[h].x, table_.particle_blocks[h].y,
               table_.particle_blocks[h].z, 0};
  block_keys_.write(keys);
}

// Tiles are numbered anew: a block near a shell has three in a row.
int ParticleStore::set_near(const std::vector<std::uint8_t>& near) {
  int tile = 0;
  for (std::size_t h = 0; h < particle_blocks_.size(); ++h) {
    particle_blocks_[h].tile = tile;
    particle_blocks_[h].near = near[h];
    tile += near[h] != 0 ? 3 : 1;
  }
  particle_blocks_buffer_.write(particle_blocks_);
  return tile;
}

std::vector<Particle> ParticleStore::sorted(std::vector<Particle> particles) {
  for (Particle& p : particles) find_particle_block(p);
  // By cell inside a block, as a re-bin does. Small keys are sorted: moving whole particles takes
  // three times as long.
  struct Place {
    BlockKey particle_block;
    int cell;
    std::uint32_t from;
  };
  std::vector<Place> places(particles.size());
  for (std::size_t i = 0; i < particles.size(); ++i)
    places[i] = {key_of(particles[i]), cell_of(particles[i]), static_cast<std::uint32_t>(i)};
  std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
    if (!(a.particle_block == b.particle_block)) return a.particle_block < b.particle_block;
    return a.cell != b.cell ? a.cell < b.cell : a.from < b.from;
  });
  std::vector<Particle> out;
  out.reserve(particles.size());
  // Ties were broken by the old index, so the order does not depend on the sort's algorithm.
  for (const Place& place : places) out.push_back(particles[place.from]);
  return out;
}

// Some spare memory is allocated: soil becomes active in small portions.
void ParticleStore::reserve(int side, int slots, int wanted) {
  if (slots <= capacity_[side] && !state_[side].empty()) return;
  // Contents are lost; callers write all slots afterwards.
  const int capacity = padded(std::max(wanted, 1024));
  state_[side] = device::Buffer<float>(device_, static_cast<std::size_t>(capacity) * FIELD_COUNT);
  capacity_[side] = capacity;
}

void ParticleStore::place(const std::vector<Particle>& sorted) {
  // One key and one count for each run of equal keys.
  std::vector<BlockKey> keys;
  std::vector<int> counts;
  for (const Particle& p : sorted) {
    if (keys.empty() || !(keys.back() == key_of(p))) {
      keys.push_back(key_of(p));
      counts.push_back(0);
    }
    ++counts.back();
  }
  // Memory first, as in `rebin`: when the device is full, the store keeps its contents.
  const int slots = slots_of(counts);
  fit(device_, particle_blocks_buffer_, keys.size());
  fit(device_, block_keys_, keys.size());
  fit(device_, block_surface_, keys.size());
  // A half more than needed, so that soil that becomes active rarely needs new memory.
  reserve(now_, slots, slots + slots / 2);
  // Sorted particles of one block are contiguous, so the keys are sorted and unique, too.
  table_.build(std::move(keys));
  assign_slots(counts);
  {
    // Every slot of the runs is written, padding included: kernels read whole packs.
    const auto view = state_[now_].map_update();
    const auto capacity = static_cast<std::size_t>(capacity_[now_]);
    std::size_t next = 0;
    for (const ParticleBlock& particle_block : particle_blocks_) {
      const auto start = static_cast<std::size_t>(particle_block.start),
                 n = static_cast<std::size_t>(particle_block.count);
      for (std::size_t i = 0; i < n; ++i)
        put_record(sorted[next++], view.data(), capacity, start + i);
      for (std::size_t i = n; i < static_cast<std::size_t>(padded(particle_block.count)); ++i)
        put_record(empty_lane(), view.data(), capacity, start + i);
    }
  }
  upload_particle_blocks();
  block_surface_.write(surfaces(sorted));
}

std::vector<ContactSoil> ParticleStore::surfaces(const std::vector<Particle>& sorted) const {
  // The same sums in the same order as in rebin_move: differences from the first, word by word.
  constexpr std::array kWords{std::pair(&ContactSoil::friction, &SoilRow::tool_friction),
                              std::pair(&ContactSoil::adhesion, &SoilRow::adhesion),
                              std::pair(&ContactSoil::inv_density, &SoilRow::inv_density)};
  std::vector<ContactSoil> out(particle_blocks_.size());
  std::size_t next = 0;
  for (std::size_t h = 0; h < particle_blocks_.size(); ++h) {
    const auto count = static_cast<std::size_t>(particle_blocks_[h].count);
    for (const auto& [mean, of_soil] : kWords) {
      const auto value = [&, word = of_soil](std::size_t i) {
        return soil_rows_[sorted[i].soil].*word;
      };
      float more = 0;
      for (std::size_t i = next; i < next + count; ++i) more += value(i) - value(next);
      out[h].*mean = value(next) + more / static_cast<float>(count);
    }
    next += count;
  }
  return out;
}

std::vector<Particle> ParticleStore::records() const {
  std::vector<Particle> out(static_cast<std::size_t>(count_));
  if (count_ == 0) return out;
  const auto view = state_[now_].map_read();
  Particle* next = out.data();
  for (std::size_t h = 0; h < particle_blocks_.size(); ++h) {
    const auto count = static_cast<std::size_t>(particle_blocks_[h].count);
    get_records(view.data() + particle_blocks_[h].start, static_cast<std::size_t>(capacity_[now_]),
                {next, count});
    for (std::size_t i = 0; i < count; ++i, ++next) {
      next->block[0] = table_.particle_blocks[h].x;
      next->block[1] = table_.particle_blocks[h].y;
      next->block[2] = table_.particle_blocks[h].z;
    }
  }
  return out;
}

void ParticleStore::exchange_records(std::vector<Particle>& out) const {
  out.resize(static_cast<std::size_t>(count_));
  if (count_ == 0) return;
  // Two ranges of the state hold all of it.
  static_assert(FIELD_X == 0 && FIELD_V == 3 && FIELD_C == 6);
  static_assert(FIELD_J0 + 5 == FIELD_COUNT && FIELD_SHEAR > FIELD_J0 && FIELD_MASS > FIELD_J0 &&
                FIELD_TAG > FIELD_J0 && FIELD_ID > FIELD_J0);
  const auto capacity = static_cast<std::size_t>(capacity_[now_]);
  // The second map waits for both.
  const auto motion = state_[now_].map_read_later(0, FIELD_C * capacity);
  const auto rest = state_[now_].map_read(FIELD_J0 * capacity, 5 * capacity);
  Particle* next = out.data();
  for (std::size_t h = 0; h < particle_blocks_.size(); ++h) {
    const auto start = static_cast<std::size_t>(particle_blocks_[h].start),
               count = static_cast<std::size_t>(particle_blocks_[h].count);
    const BlockKey& key = table_.particle_blocks[h];
    const auto each = [&](std::size_t field, const auto& set) {
      const float* from = field < FIELD_C ? motion.data() + field * capacity + start
                                          : rest.data() + (field - FIELD_J0) * capacity + start;
      for (std::size_t i = 0; i < count; ++i) set(next[i], from[i]);
    };
    for (std::size_t a = 0; a < 3; ++a) {
      each(FIELD_X + a, [a](Particle& p, float w) { p.x[a] = w; });
      each(FIELD_V + a, [a](Particle& p, float w) { p.v[a] = w; });
    }
    each(FIELD_J0, [](Particle& p, float w) { p.j0 = w; });
    each(FIELD_SHEAR, [](Particle& p, float w) { p.shear = w; });
    get_integers(each);
    for (std::size_t i = 0; i < count; ++i, ++next) {
      next->block[0] = key.x;
      next->block[1] = key.y;
      next->block[2] = key.z;
    }
  }
}

std::vector<Particle> ParticleStore::drop_outside() {
  // Rare: a few particles leave the site. The host selects those that stay.
  const std::vector<Particle> all = records();
  // The last code stands for a place outside the site.
  const std::vector<std::uint8_t> codes = rebin_.codes();
  std::vector<Particle> stay, left;
  std::size_t next = 0;
  for (const ParticleBlock& particle_block : particle_blocks_)
    for (int i = 0; i < particle_block.count; ++i) {
      const bool out = codes[static_cast<std::size_t>(particle_block.start + i)] == kRebinCodes - 1;
      (out ? left : stay).push_back(all[next++]);
    }
  assign(stay);
  return left;
}

std::vector<Particle> ParticleStore::rebin() {
  if (count_ == 0) return {};
  const std::size_t old_particle_blocks = particle_blocks_.size();
  // Only counts come to the host: how many particles go from each block to each of its neighbours.
  // The particles themselves move on the device.
  const std::vector<int> counts =
      rebin_.count({state_[now_], capacity_[now_], particle_blocks_buffer_}, old_particle_blocks,
                   block_keys_, site_);
  for (std::size_t h = 0; h < old_particle_blocks; ++h)
    if (counts[kRebinCodes * h + kRebinCodes - 1] > 0) return drop_outside();

  move(plan_rebin(table_, counts), {});
  return {};
}

void ParticleStore::change(const std::vector<std::uint8_t>& removed,
                           const std::vector<Particle>& added) {
  if (count_ == 0) return assign(added);
  // Flags by slot, as the kernels number particles.
  std::vector<std::uint8_t> flags;
  if (!removed.empty()) {
    const ParticleBlock& last = particle_blocks_.back();
    flags.assign(static_cast<std::size_t>(last.start + last.count), 0);
    auto from = removed.begin();
    for (const ParticleBlock& block : particle_blocks_) {
      std::copy(from, from + block.count, flags.begin() + block.start);
      from += block.count;
    }
  }
  // Particles beyond the site stay until the next re-bin records their mass.
  const std::vector<int> counts =
      rebin_.count({state_[now_], capacity_[now_], particle_blocks_buffer_},
                   particle_blocks_.size(), block_keys_, kEverywhere, flags);
  const AddedParticles more = added_particles(sorted(added));
  const RebinPlan plan = plan_rebin(table_, counts, &more);
  if (plan.keys.empty()) return assign({});
  move(plan, more);
}

void ParticleStore::move(const RebinPlan& plan, const AddedParticles& added) {
  // Memory first: on failure the old order is still valid.
  const int other = 1 - now_;
  const int slots = slots_of(plan.counts);
  reserve(other, slots, std::max(slots + slots / 4, capacity_[now_]));
  fit(device_, old_particle_blocks_buffer_, plan.keys.size());
  fit(device_, block_keys_, plan.keys.size());
  fit(device_, block_surface_, plan.keys.size());
  rebin_.reserve(plan.keys.size(), static_cast<std::size_t>(slots));
  rebin_.add({state_[now_], capacity_[now_], particle_blocks_buffer_}, particle_blocks_.size(),
             added);
  // After this point only the device itself can fail.
  std::swap(particle_blocks_buffer_, old_particle_blocks_buffer_);
  // Most re-bins leave the set of blocks as it was, and tables are expensive.
  if (!(plan.keys == table_.particle_blocks)) table_.build(plan.keys);
  assign_slots(plan.counts);
  upload_particle_blocks();
  rebin_.move({state_[now_], capacity_[now_], old_particle_blocks_buffer_},
              {state_[other], capacity_[other], particle_blocks_buffer_}, plan, soils_,
              block_surface_);
  now_ = other;
}

// Reads the words in place: particle by particle would take twice as long.
void ParticleStore::visit(Archive& a) {
  if (a.loading()) {
    std::vector<Particle> records;
    visit(a, records, soil_rows_.size());
    place(records);
    return;
  }
  a.size("blocks", particle_blocks_.size());
  if (particle_blocks_.empty()) return;
  const auto view = state_[now_].map_read();
  const auto capacity = static_cast<std::size_t>(capacity_[now_]);
  BlockWords particle_block;
  for (std::size_t h = 0; h < particle_blocks_.size(); ++h) {
    particle_block.block = {table_.particle_blocks[h].x, table_.particle_blocks[h].y,
                            table_.particle_blocks[h].z};
    particle_block.take(view.data() + particle_blocks_[h].start, capacity,
                        static_cast<std::size_t>(particle_blocks_[h].count));
    a.item(h, [&] { particle_block.visit(a); });
  }
}

void ParticleStore::visit(Archive& a, std::vector<Particle>& records, std::size_t soils) {
  // Records are sorted, so a block is a run of equal keys.
  const auto end_of_block = [&](std::size_t from) {
    std::size_t to = from;
    while (to < records.size() && key_of(records[to]) == key_of(records[from])) ++to;
    return to;
  };
  std::uint64_t particle_blocks = 0;
  for (std::size_t from = 0; from < records.size(); from = end_of_block(from)) ++particle_blocks;
  particle_blocks = a.size("blocks", particle_blocks);
  if (a.loading()) records.clear();
  BlockWords particle_block;
  BlockKey before;
  std::size_t from = 0;
  for (std::uint64_t h = 0; h < particle_blocks; ++h) {
    if (!a.loading()) {
      const std::size_t to = end_of_block(from);
      particle_block.take(std::span(records).subspan(from, to - from));
      from = to;
    }
    a.item(h, [&] {
      particle_block.visit(a);
      // Tables are built from keys that are sorted and unique.
      a.require(h == 0 || before < particle_block.key(), "block", "blocks must ascend");
      before = particle_block.key();
      if (a.loading()) particle_block.give(a, records, soils);
    });
  }
}

}  // namespace navvy::soil
