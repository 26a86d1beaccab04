// SPDX-License-Identifier: Apache-2.0
#include "bench/native/native_soil.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "bench/native/native_lanes.h"
#include "soil/particles/floor.h"
#include "soil/particles/soil_table.h"

namespace navvy::bench {
namespace {

/// Nodes around the sorted particles, for their drift and the kernel's reach.
constexpr int kMargin = 2;
constexpr std::size_t kCells = 216;
/// Equals kMaxDrift of src/soil/soil_particles.h.
constexpr double kMostDrift = 0.75;

/// Returns the constants of the law, with the same number in every lane.
LawSoil law_of(const scene::Soil& soil, double cell) {
  const soil::LawConstants law = soil::law_constants(soil, cell);
  LawSoil out;
#define LANES_CONSTANT(name) out.name = Lanes{} + static_cast<float>(law.name);
  LAW_CONSTANTS(LANES_CONSTANT)
#undef LANES_CONSTANT
  return out;
}

/// Block, cell of the base node floor(x - 0.5) in it, then the order of ids.
struct SortKey {
  std::array<int, 3> particle_block{};
  int cell = 0;
  std::size_t index = 0;
  bool operator<(const SortKey& o) const {
    if (particle_block != o.particle_block)
      return std::tie(particle_block[2], particle_block[1], particle_block[0]) <
             std::tie(o.particle_block[2], o.particle_block[1], o.particle_block[0]);
    return cell != o.cell ? cell < o.cell : index < o.index;
  }
};

/// Returns the key of a particle; `index` breaks ties, so the order is that of the ids.
SortKey sort_key(const soil::Particle& p, std::size_t index) {
  SortKey key;
  key.index = index;
  for (std::size_t a = 3; a-- > 0;) {
    const int base = soil::kBlockCells * p.block[a] + static_cast<int>(std::floor(p.x[a] - 0.5f));
    key.particle_block[a] = base >> 2;
    key.cell = 4 * key.cell + (base & 3);
  }
  return key;
}

}  // namespace

NativeSoil::NativeSoil(const scene::Soil& soil, double cell, double ground)
    : soil_(soil),
      cell_(static_cast<float>(cell)),
      ground_(static_cast<float>(ground)),
      transfer_length_(soil::kScheme.transfer_length * cell / soil::sound_speed(soil)),
      sums_(kCells),
      openings_(kCells) {}

void NativeSoil::insert(const std::vector<soil::Particle>& particles) {
  // Ids number the particles in the order of their insertion.
  std::vector<soil::Particle> all = this->particles();
  for (soil::Particle p : particles) {
    p.id = static_cast<std::uint32_t>(all.size());
    all.push_back(p);
  }
  sort(all);
}

std::vector<soil::Particle> NativeSoil::particles() const {
  std::vector<soil::Particle> out(count_);
  for (const ParticleBlock& particle_block : particle_blocks_)
    for (std::size_t i = 0; i < particle_block.count; ++i) {
      const Pack& pack = packs_[particle_block.first + i / kLanes];
      const std::size_t l = i % kLanes;
      soil::Particle& p = out[pack.id[l]];
      for (std::size_t a = 0; a < 3; ++a)
        p.block[a] = (window_[a] + particle_block.corner[a]) / soil::kBlockCells;
#define GET_ONE(NAME, member, rest) p.member = pack.member[l];
#define GET_MANY(NAME, member, count, rest) \
  for (std::size_t k = 0; k < (count); ++k) p.member[k] = pack.member[k][l];
      FLOAT_FIELDS(GET_ONE, GET_MANY)
#undef GET_ONE
#undef GET_MANY
      for (int a = 0; a < 3; ++a) p.x[a] += std::exchange(p.moved[a], 0.0f);
      p.mass =
          static_cast<std::int32_t>(std::lround(pack.mass[l] / static_cast<float>(kMassQuantum)));
      p.id = pack.id[l];
    }
  return out;
}

void NativeSoil::sort(const std::vector<soil::Particle>& particles) {
  // One sort of small keys; the particles follow once.
  std::vector<SortKey> keys;
  keys.reserve(particles.size());
  std::array<int, 3> low{INT32_MAX, INT32_MAX, INT32_MAX}, high{INT32_MIN, INT32_MIN, INT32_MIN};
  for (const soil::Particle& p : particles) {
    keys.push_back(sort_key(p, keys.size()));
    for (std::size_t a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], keys.back().particle_block[a]);
      high[a] = std::max(high[a], keys.back().particle_block[a]);
    }
  }
  std::sort(keys.begin(), keys.end());
  for (std::size_t a = 0; a < 3; ++a) {
    window_[a] = soil::kBlockCells * low[a];
    nodes_[a] = soil::kBlockCells * (high[a] - low[a] + 1) + 2 + 2 * kMargin;
  }
  // A dense grid over the bounding box of the blocks. The solver has a sparse one; for a compact
  // heap the difference is small.
  row_ = static_cast<std::size_t>(nodes_[0]);
  rows_ = static_cast<std::size_t>(nodes_[1]);
  grid_.assign(row_ * rows_ * static_cast<std::size_t>(nodes_[2]), Float4{});
  velocity_ = grid_;
  interval_ = {};
  packs_.clear();
  particle_blocks_.clear();
  count_ = particles.size();
  drift_ = 0;
  ++sorts_;
  for (std::size_t n = 0; n < keys.size(); ++n) {
    if (n == 0 || keys[n].particle_block != keys[n - 1].particle_block) {
      ParticleBlock particle_block;
      particle_block.first = packs_.size();
      for (std::size_t a = 0; a < 3; ++a)
        particle_block.corner[a] = soil::kBlockCells * (keys[n].particle_block[a] - low[a]);
      particle_blocks_.push_back(particle_block);
    }
    append(particles[keys[n].index]);
  }
}

void NativeSoil::append(const soil::Particle& p) {
  ParticleBlock& particle_block = particle_blocks_.back();
  const std::size_t l = particle_block.count++ % kLanes;
  if (l == 0) {
    // Lanes without a particle: no mass, inside the block.
    packs_.emplace_back();
#define REST_ONE(NAME, member, rest) \
  std::fill(std::begin(packs_.back().member), std::end(packs_.back().member), rest);
#define REST_MANY(NAME, member, count, rest) \
  for (auto& lanes : packs_.back().member) std::fill(std::begin(lanes), std::end(lanes), rest);
    FLOAT_FIELDS(REST_ONE, REST_MANY)
#undef REST_ONE
#undef REST_MANY
  }
  Pack& pack = packs_.back();
#define PUT_ONE(NAME, member, rest) pack.member[l] = p.member;
#define PUT_MANY(NAME, member, count, rest) \
  for (std::size_t k = 0; k < (count); ++k) pack.member[k][l] = p.member[k];
  FLOAT_FIELDS(PUT_ONE, PUT_MANY)
#undef PUT_ONE
#undef PUT_MANY
  for (std::size_t a = 0; a < 3; ++a)
    pack.x[a][l] +=
        static_cast<float>(soil::kBlockCells * p.block[a] - window_[a] - particle_block.corner[a]);
  pack.mass[l] = static_cast<float>(kilograms(p.mass));
  pack.id[l] = p.id;
}

bool NativeSoil::sum_openings(const ParticleBlock& particle_block) {
  // Most blocks have no opened soil and skip the sums.
  bool open = false;
  const std::size_t packs = (particle_block.count + kLanes - 1) / kLanes;
  for (std::size_t n = 0; n < packs && !open; ++n) {
    const Pack& pack = packs_[particle_block.first + n];
    for (std::size_t l = 0; l < kLanes; ++l) open |= pack.j[l] > pack.j0[l];
  }
  if (!open) return false;
  std::fill(sums_.begin(), sums_.end(), std::array<float, 3>{});
  for (std::size_t i = 0; i < particle_block.count; ++i) {
    const Pack& pack = packs_[particle_block.first + i / kLanes];
    const std::size_t l = i % kLanes;
    std::array<float, 3>& sum = sums_[cell_of(pack.x[0][l], pack.x[1][l], pack.x[2][l])];
    sum[0] += pack.mass[l] * pack.j[l];
    sum[1] += pack.mass[l] * pack.j0[l];
    if (pack.j[l] > pack.j0[l]) sum[2] = 1;
  }
  // Sums sixteen cells at a time in mass quanta, as the kernels do.
  constexpr float kQuanta = 1 / MASS_QUANTUM;
  for (std::size_t first = 0; first < kCells; first += kLanes) {
    const std::size_t cells = std::min(kLanes, kCells - first);
    Lanes volume{}, bank{}, opened{};
    for (std::size_t l = 0; l < cells; ++l) {
      volume[l] = kQuanta * sums_[first + l][0];
      bank[l] = kQuanta * sums_[first + l][1];
      opened[l] = sums_[first + l][2];
    }
    const Lanes mean = mean_opening(volume, bank, opened);
    for (std::size_t l = 0; l < cells; ++l) openings_[first + l] = mean[l];
  }
  return true;
}

std::size_t NativeSoil::first_node(const Weights& w, std::size_t l,
                                   const ParticleBlock& particle_block) const {
  int base[3];
  for (std::size_t a = 0; a < 3; ++a) base[a] = w.base[a][l] + particle_block.corner[a] + kMargin;
  return node(base);
}

void NativeSoil::scatter(const ParticleBlock& particle_block, float dt, bool hold) {
  const LawSoil law = law_of(soil_, static_cast<double>(cell_));
  const float dx = cell_, inv_density = static_cast<float>(1 / soil_.bank_density);
  const auto mixing = static_cast<float>(static_cast<double>(dt) / soil::kScheme.mixing_strain);
  const auto most = static_cast<float>(soil::most_mixing(static_cast<double>(dt)));
  const bool open = sum_openings(particle_block);
  for (std::size_t first = 0; first < particle_block.count; first += kLanes) {
    Pack& pack = packs_[particle_block.first + first / kLanes];
    const std::size_t lanes = std::min(kLanes, particle_block.count - first);
    Lanes c[9], v[3], sigma[6], opening{};
    for (int k = 0; k < 9; ++k) c[k] = load(pack.c[k]);
    for (int k = 0; k < 3; ++k) v[k] = load(pack.v[k]);
    if (open)
      for (std::size_t l = 0; l < lanes; ++l)
        opening[l] = openings_[cell_of(pack.x[0][l], pack.x[1][l], pack.x[2][l])];
    LawState state;
#define LOAD_ONE(NAME, member, rest) state.member = load(pack.member);
#define LOAD_MANY(NAME, member, count, rest) \
  for (int k = 0; k < (count); ++k) state.member[k] = load(pack.member[k]);
    LAW_STATE_FIELDS(LOAD_ONE, LOAD_MANY)
    advance_state(c, dt, &law, opening, mixing, most, &state, sigma);
#define STORE_ONE(NAME, member, rest) store(state.member, pack.member);
#define STORE_MANY(NAME, member, count, rest) \
  for (int k = 0; k < (count); ++k) store(state.member[k], pack.member[k]);
    LAW_STATE_FIELDS(STORE_ONE, STORE_MANY)

    Weights w(pack.x[0], pack.x[1], pack.x[2]);
    const Lanes mass = load(pack.mass);
    Lanes a[9], p[3];
    affine_momentum(c, sigma, v, w.f, mass, mass * inv_density, state.j, hold ? 0.0f : 1.0f, dt, dx,
                    p, a);
    // Transposes one array per component into one vector per particle: momentum and mass at the
    // base node, and their increments along each axis.
    Four start[kLanes], ax[kLanes], ay[kLanes], az[kLanes];
    turn(p[0], p[1], p[2], mass, start);
    turn(a[0], a[3], a[6], Lanes{}, ax);
    turn(a[1], a[4], a[7], Lanes{}, ay);
    turn(a[2], a[5], a[8], Lanes{}, az);
    for (std::size_t l = 0; l < lanes; ++l) {
      Float4* layer = grid_.data() + first_node(w, l, particle_block);
      Four plane = start[l];
      for (int k = 0; k < 3; ++k, layer += row_ * rows_, plane += az[l]) {
        Four row = plane;
        for (std::size_t i = 0; i < 3; ++i, row += ay[l]) {
          const float wyz = w.w[2][k][l] * w.w[1][i][l];
          Float4* out = layer + i * row_;
          const Four next = row + ax[l], last = next + ax[l];
          out[0] += (wyz * w.w[0][0][l]) * row;
          out[1] += (wyz * w.w[0][1][l]) * next;
          out[2] += (wyz * w.w[0][2][l]) * last;
        }
      }
    }
  }
}

void NativeSoil::update_grid(float dt, bool hold) {
  const float fall = static_cast<float>(kGravity) * dt, empty = static_cast<float>(kMassQuantum);
  std::size_t n = 0;
  for (int z = 0; z < nodes_[2]; ++z) {
    // Layers below the held margin above the ground do not move, as in the solver.
    const float above = static_cast<float>(z - kMargin + window_[2]) - ground_;
    const auto margin = static_cast<float>(soil::kScheme.held_margin);
    const bool held = above <= margin, topmost = held && above + 1 > margin;
    const float per_free_fraction = 1 / free_fraction_above(above);
    const std::size_t layer = row_ * rows_;
    for (std::size_t end = n + layer; n < end; ++n) {
      Float4 node = grid_[n];
      const float mass = node[3];
      if (mass > empty && (!held || topmost)) {
        node *= INVERSE_MASS(mass);
        node[2] -= fall;
        // Within a transfer the scatter adds changes of momentum only, so the velocity is updated.
        if (hold) node += velocity_[n];
        if (topmost) {
          const float over = z + 1 < nodes_[2] ? grid_[n + layer][3] : 0.0f;
          node = Float4{0, 0, std::min(node[2], 0.0f) * falling_share(mass, over, above), 0};
        }
      } else {
        node = Float4{};
      }
      node[3] = mass * per_free_fraction;
      velocity_[n] = node;
    }
  }
}

float NativeSoil::gather(const ParticleBlock& particle_block, float dt) {
  const float dx = cell_;
  const auto cell = static_cast<double>(dx);
  const double part = std::min(1.0, static_cast<double>(dt) / transfer_length_);
  const auto full = static_cast<float>(soil::packed_mass(soil_.bank_density, cell));
  const auto filled = static_cast<float>(soil::filled_mass(soil_.bank_density, cell));
  const auto closing = static_cast<float>(soil::kScheme.closing_share * part);
  const auto spread = static_cast<float>(static_cast<double>(dt) / soil::kScheme.crowding_strain);
  const auto most = static_cast<float>(soil::kScheme.max_crowding_displacement * part);
  Lanes fastest{};
  for (std::size_t first = 0; first < particle_block.count; first += kLanes) {
    Pack& pack = packs_[particle_block.first + first / kLanes];
    const std::size_t lanes = std::min(kLanes, particle_block.count - first);
    Weights w(pack.x[0], pack.x[1], pack.x[2]);
    Four v[kLanes]{}, mx[kLanes]{}, my[kLanes]{}, mz[kLanes]{};
    for (std::size_t l = 0; l < lanes; ++l) {
      const Float4* layer = velocity_.data() + first_node(w, l, particle_block);
      Four sum{}, sum_x{}, sum_y{}, sum_z{};
      for (int k = 0; k < 3; ++k, layer += row_ * rows_) {
        Four plane{}, plane_x{}, plane_y{};
        for (std::size_t i = 0; i < 3; ++i) {
          const Float4* in = layer + i * row_;
          const Four b = w.w[0][1][l] * in[1], c = w.w[0][2][l] * in[2];
          const Four row = (w.w[0][0][l] * in[0] + b + c) * w.w[1][i][l];
          plane += row;
          plane_x += (b + 2 * c) * w.w[1][i][l];
          plane_y += static_cast<float>(i) * row;
        }
        sum += w.w[2][k][l] * plane;
        sum_x += w.w[2][k][l] * plane_x;
        sum_y += w.w[2][k][l] * plane_y;
        sum_z += (static_cast<float>(k) * w.w[2][k][l]) * plane;
      }
      v[l] = sum, mx[l] = sum_x, my[l] = sum_y, mz[l] = sum_z;
    }
    // v, C = 4/dx^2 sum w v (x_i - x_p)^T, moved += dt v, and a separation where soil is crowded.
    // The fourth component is mass per free fraction.
    Lanes u[4], m[4], c[9], lean[3];
    unturn(v, u);
    const Four* moments[3] = {mx, my, mz};
    for (int axis = 0; axis < 3; ++axis) {
      unturn(moments[axis], m);
      for (int i = 0; i < 3; ++i) c[3 * i + axis] = velocity_gradient(m[i], w.f[axis], u[i], dx);
      lean[axis] = m[3] - w.f[axis] * u[3];
    }
    for (int k = 0; k < 9; ++k) store(c[k], pack.c[k]);
    const Lanes j = load(pack.j), j0 = load(pack.j0),
                share = crowding(c, j, j0, u[3], full, spread);
    store(close_noise(j, j0, u[3], filled, closing), pack.j);
    for (int a = 0; a < 3; ++a) {
      store(u[a], pack.v[a]);
      const Lanes displacement =
          (dt / dx) * u[a] + crowding_displacement(share, lean[a], u[3], most);
      store(load(pack.moved[a]) + displacement, pack.moved[a]);
      m[a] = displacement * (dx / dt);
    }
    fastest = fmax(fastest, fastest_component(m));
  }
  return largest(fastest);
}

void NativeSoil::step(double dt) {
  const auto cell = static_cast<double>(cell_);
  const bool hold = interval_.holds(dt, transfer_length_, cell, 0, kGravity);
  if (!hold) end_transfer();
  // Sorting only keeps memory accesses local; results do not depend on it except by rounding.
  if (drift_ > kMostDrift) sort(particles());
  std::fill(grid_.begin(), grid_.end(), Float4{});
  for (const ParticleBlock& particle_block : particle_blocks_)
    scatter(particle_block, static_cast<float>(dt), hold);
  update_grid(static_cast<float>(dt), hold);
  float fastest = 0;
  for (const ParticleBlock& particle_block : particle_blocks_)
    fastest = std::max(fastest, gather(particle_block, static_cast<float>(dt)));
  interval_.count_step(dt, cell, static_cast<double>(fastest), 0);
}

void NativeSoil::end_transfer() {
  // Particles take over the displacement of the transfer.
  drift_ += interval_.motion;
  interval_ = {};
  for (Pack& pack : packs_)
    for (int a = 0; a < 3; ++a) {
      store(load(pack.x[a]) + load(pack.moved[a]), pack.x[a]);
      store(Lanes{}, pack.moved[a]);
    }
}

}  // namespace navvy::bench
