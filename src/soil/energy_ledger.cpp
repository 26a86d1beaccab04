// SPDX-License-Identifier: Apache-2.0
#include "soil/energy_ledger.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "soil/host_law/double_law.h"
#include "soil/particles/soil_table.h"

namespace navvy::soil {
namespace {

/// Rounding of a volume ratio stored as a float, two units in its last place. A larger jump between
/// two steps is mixing.
constexpr double kRoundingOfJ = 2.5e-7;
/// Rounding of a position within a block [cells].
constexpr double kRounding = 1e-6;

/// Returns elastic energy of volume / bank volume [Pa]: the integral of p over the compression.
double volume_energy(const SoilRow& soil, double j, double j0) {
  const double closed = std::max(0.0, 1 - j / j0);
  return 0.5 * static_cast<double>(soil.bulk) * j0 * closed * closed;
}

/// Returns a : b for symmetric tensors given as xx, yy, zz, xy, yz, zx.
double dot_of(const double* a, const double* b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + 2 * (a[3] * b[3] + a[4] * b[4] + a[5] * b[5]);
}

/// Returns the index, among the nodes of the active blocks, of each of the 8 x 8 x 8 nodes of a
/// block's tile.
std::array<std::size_t, 512> tile_nodes(const BlockTable& table, std::size_t particle_block) {
  std::array<std::size_t, 512> out{};
  for (int i = 0; i < 512; ++i) {
    const int t[3] = {i % 8 - 1, i / 8 % 8 - 1, i / 64 - 1};
    int n = 0, local = 0;
    for (int a = 2; a >= 0; --a) {
      const int d = t[a] < 0 ? -1 : t[a] > 3 ? 1 : 0;
      n = 3 * n + d + 1;
      local = 4 * local + t[a] - 4 * d;
    }
    out[static_cast<std::size_t>(i)] =
        static_cast<std::size_t>(
            table.neighbours[27 * particle_block + static_cast<std::size_t>(n)]) *
            BLOCK_NODES +
        static_cast<std::size_t>(local);
  }
  return out;
}

/// Returns 0 for nodes with one field, else 1 + own, own = 0 front, 1 back, by node of the active
/// blocks; as node_split of the kernels.
std::vector<std::int32_t> splits(std::size_t nodes, NearNodes& near) {
  std::vector<std::int32_t> out(nodes, 0);
  if (near.count == 0) return out;
  const auto blocks = static_cast<std::size_t>(near.count);
  const auto list = near.list.map_read(0, blocks);
  const auto split = near.split.map_read(0, blocks * BLOCK_NODES);
  for (std::size_t b = 0; b < blocks; ++b)
    std::copy_n(split.begin() + static_cast<std::ptrdiff_t>(b * BLOCK_NODES), BLOCK_NODES,
                out.begin() + static_cast<std::ptrdiff_t>(list[b]) * BLOCK_NODES);
  return out;
}

}  // namespace

// Integer fields are stored as the bits of a float.
int EnergyLedger::Words::bits(int field, std::size_t slot) const {
  return std::bit_cast<int>(values[static_cast<std::size_t>(field) * capacity + slot]);
}

EnergyLedger::EnergyLedger(const std::vector<scene::Soil>& soils, double cell, const Vec3& gravity,
                           const SchemeConstants& scheme)
    : soils_(soil_table(soils, cell, scheme)), scheme_(scheme), cell_(cell), gravity_(gravity) {}

EnergyLedger::Words EnergyLedger::words_of(const ParticleStore& store) {
  Words out;
  out.capacity = static_cast<std::size_t>(store.capacity());
  const auto read = store.state().map_read(0, FIELD_COUNT * out.capacity);
  out.values.assign(read.begin(), read.end());
  return out;
}

/// Calls visit(block, slot) for every particle, in stored order.
template <class Visit>
void EnergyLedger::for_particles(const ParticleStore& store, const Visit& visit) {
  const std::vector<ParticleBlock>& particle_blocks = store.particle_blocks();
  for (std::size_t h = 0; h < particle_blocks.size(); ++h)
    for (int i = 0; i < particle_blocks[h].count; ++i)
      visit(h, static_cast<std::size_t>(particle_blocks[h].start + i));
}

// The affine part holds a quarter of a cell squared: the sum of w (x_i - x_p)^2 along an axis.
double EnergyLedger::moving_energy(const ParticleStore& store, const Words& now) const {
  double sum = 0;
  for_particles(store, [&](std::size_t, std::size_t slot) {
    double v2 = 0, c2 = 0;
    for (int a = 0; a < 3; ++a) v2 += std::pow(now.at(FIELD_V + a, slot), 2);
    for (int a = 0; a < 9; ++a) c2 += std::pow(now.at(FIELD_C + a, slot), 2);
    sum += 0.5 * kMassQuantum * now.bits(FIELD_MASS, slot) * (v2 + 0.25 * cell_ * cell_ * c2);
  });
  return sum;
}

double EnergyLedger::elastic_energy(const ParticleStore& store, const Words& now) const {
  double sum = 0;
  for_particles(store, [&](std::size_t, std::size_t slot) {
    const SoilRow& soil = soils_[static_cast<std::size_t>(now.bits(FIELD_TAG, slot) & 0xffff)];
    const double bank =
        kMassQuantum * now.bits(FIELD_MASS, slot) * static_cast<double>(soil.inv_density);
    double s[6];
    for (int a = 0; a < 6; ++a) s[a] = now.at(FIELD_S + a, slot);
    const double j = now.at(FIELD_J, slot);
    // The energy of shear is s : s / 4 G per present volume.
    sum += bank * (volume_energy(soil, j, now.at(FIELD_J0, slot)) +
                   j * dot_of(s, s) / (4 * static_cast<double>(soil.shear)));
  });
  return sum;
}

// Mean stress over the step times its plastic strain. The law keeps only the stress after the
// return, which has the direction of the strain. Stress that vanished had the direction of the
// stress before.
void EnergyLedger::record_law(const ParticleStore& store, const Words& now, double dt) {
  for_particles(store, [&](std::size_t, std::size_t slot) {
    const SoilRow& soil = soils_[static_cast<std::size_t>(now.bits(FIELD_TAG, slot) & 0xffff)];
    const double bank =
        kMassQuantum * now.bits(FIELD_MASS, slot) * static_cast<double>(soil.inv_density);
    double c[9], s0[6], s1[6];
    for (int a = 0; a < 9; ++a) c[a] = before_.at(FIELD_C + a, slot);
    for (int a = 0; a < 6; ++a)
      s0[a] = before_.at(FIELD_S + a, slot), s1[a] = now.at(FIELD_S + a, slot);
    const double j = now.at(FIELD_J, slot), before = before_.at(FIELD_J, slot);
    const double j00 = before_.at(FIELD_J0, slot), j01 = now.at(FIELD_J0, slot);
    const double trace = c[0] + c[4] + c[8], volume = bank * j;
    const double mixed = j / (1 + dt * trace);
    // The law first mixes J within a cell and then integrates it. The second step is known, so the
    // first follows from the result.
    if (std::abs(mixed - before) > kRoundingOfJ)
      account_.mixing -=
          bank * (volume_energy(soil, mixed, j00) - volume_energy(soil, before, j00));
    const double slip = now.at(FIELD_SHEAR, slot) - before_.at(FIELD_SHEAR, slot);
    const double q = std::sqrt(0.5 * dot_of(s1, s1));
    const double along = q > 0 ? 0.5 * dot_of(s0, s1) / q : std::sqrt(0.5 * dot_of(s0, s0));
    // Shear: the stress along the slip, mean of before and after. Volume: J0 follows J when soil
    // dilates or compacts, which releases the difference.
    account_.plastic += volume * slip * 0.5 * (along + q);
    account_.plastic += bank * (volume_energy(soil, j, j00) - volume_energy(soil, j, j01));
    // Viscosities [docs/soil.md, viscosity].
    const double third = trace / 3;
    const double d[6] = {c[0] - third,        c[4] - third,        c[8] - third,
                         0.5 * (c[1] + c[3]), 0.5 * (c[5] + c[7]), 0.5 * (c[2] + c[6])};
    const auto viscosity = static_cast<double>(soil.viscosity);
    if (!(slip > 0)) account_.viscous += dt * volume * 2 * viscosity * dot_of(d, d);
    const double p = static_cast<double>(soil.bulk) * std::max(0.0, 1 - j / j00);
    const double damped = std::max(p - scheme_.volume_damping * viscosity * trace, 0.0);
    if (p > 0) account_.viscous += dt * volume * (p - damped) * trace;
    // A displacement without a velocity: the separation of crowded particles.
    for (int a = 0; a < 3; ++a) {
      const double apart = now.at(FIELD_MOVED + a, slot) - before_.at(FIELD_MOVED + a, slot) -
                           dt / cell_ * now.at(FIELD_V + a, slot);
      if (std::abs(apart) > kRounding)
        account_.apart -= kMassQuantum * now.bits(FIELD_MASS, slot) * gravity_[a] * apart * cell_;
    }
  });
}

// Masses and velocities of the nodes at the start of a transfer, as the scatter computes them:
// current positions and sides, previous velocities and gradients.
void EnergyLedger::scatter(const ParticleStore& store, const Words& now, Contact& contact) {
  const BlockTable& table = store.table();
  const std::size_t count = table.active.size() * BLOCK_NODES;
  nodes_.assign(2 * count, Node{});
  const std::vector<std::int32_t> split = splits(count, contact.nodes());
  std::size_t particle_block = store.particle_blocks().size();
  std::array<std::size_t, 512> tile{};
  for_particles(store, [&](std::size_t h, std::size_t slot) {
    if (h != particle_block) tile = tile_nodes(table, particle_block = h);
    const double mass = kMassQuantum * now.bits(FIELD_MASS, slot);
    Vec3 v, f;
    Mat3 c;
    double w[3][3];
    int base[3];
    for (int a = 0; a < 3; ++a) {
      const double x = now.at(FIELD_X + a, slot);
      base[a] = static_cast<int>(reference::base_node(x));
      f[a] = x - base[a];
      reference::spline(f[a], w[a]);
      v[a] = before_.at(FIELD_V + a, slot);
      for (int b = 0; b < 3; ++b) c(a, b) = cell_ * before_.at(FIELD_C + 3 * a + b, slot);
    }
    const int side = reference::tile_of(now.bits(FIELD_TAG, slot) >> 16);
    for (int n = 0; n < 27; ++n) {
      const int i[3] = {n % 3, n / 3 % 3, n / 9};
      const auto place = static_cast<std::size_t>(base[0] + i[0] + 1 + 8 * (base[1] + i[1] + 1) +
                                                  64 * (base[2] + i[2] + 1));
      const std::size_t at = tile[place];
      // Neutral soil joins the side of its node; an unsplit node joins all.
      const bool back = split[at] != 0 && (side == 0 ? split[at] == 2 : side == 2);
      Node& node = nodes_[at + (back ? count : 0)];
      // The same sums as on the device, in doubles: velocity of the particle at the node, weighted
      // by the mass that it gives to the node.
      const double share = w[0][i[0]] * w[1][i[1]] * w[2][i[2]] * mass;
      node.mass += share;
      node.v += share * (v + c * (Vec3(i[0], i[1], i[2]) - f));
    }
  });
  // Nodes below one mass quantum hold rounding only.
  for (Node& node : nodes_)
    node.v = node.mass > kMassQuantum ? Vec3(node.v / node.mass) : Vec3(Vec3::Zero());
}

double EnergyLedger::nodes_energy() const {
  double sum = 0;
  for (const Node& node : nodes_) sum += 0.5 * node.mass * node.v.squaredNorm();
  return sum;
}

std::vector<Vec3> EnergyLedger::velocities(Transfer& transfer, Contact& contact) const {
  const std::size_t count = nodes_.size() / 2;
  std::vector<Vec3> out(nodes_.size(), Vec3::Zero());
  // Four words per node: velocity, and mass per free fraction.
  const auto front = transfer.velocity().map_read(0, 4 * count);
  for (std::size_t i = 0; i < count; ++i)
    out[i] = Vec3(front[4 * i], front[4 * i + 1], front[4 * i + 2]);
  NearNodes& near = contact.nodes();
  if (near.count == 0) return out;
  const auto list = near.list.map_read(0, static_cast<std::size_t>(near.count));
  const auto back = near.velocity1.map_read(0, near.values());
  for (std::size_t b = 0; b < list.size(); ++b)
    for (std::size_t n = 0; n < BLOCK_NODES; ++n) {
      const std::size_t from = 4 * (b * BLOCK_NODES + n);
      out[count + static_cast<std::size_t>(list[b]) * BLOCK_NODES + n] =
          Vec3(back[from], back[from + 1], back[from + 2]);
    }
  return out;
}

// Tools do work with the twist that the contact was solved for. What the nodes did not get of it is
// sliding and impact.
void EnergyLedger::record_tools(Contact& contact, const std::vector<Vec3>& after,
                                std::span<const ToolMotion> motions,
                                std::span<const ToolImpulse> impulses) {
  // Of edges and of all nodes.
  double work = 0, edge_work = 0, got = 0, edge_got = 0;
  for (std::size_t m = 0; m < motions.size(); ++m) {
    Vec6 twist, impulse, edge;
    twist << motions[m].w_WT, motions[m].v_WT;
    impulse << impulses[m].L_W, impulses[m].J_W;
    edge << impulses[m].L_edge_W, impulses[m].J_edge_W;
    const Vec6 after_step = twist + motions[m].inverse_mass * impulse;
    work -= impulse.dot(after_step);
    edge_work -= edge.dot(after_step);
  }
  const auto blocks = static_cast<std::size_t>(contact.nodes().count);
  const std::size_t count = nodes_.size() / 2;
  if (blocks > 0 && !motions.empty()) {
    const auto list = contact.nodes().list.map_read(0, blocks);
    const auto first = contact.first().map_read(0, blocks + 1);
    const auto records = contact.records().map_read(0, static_cast<std::size_t>(first[blocks]));
    for (std::size_t b = 0; b < blocks; ++b)
      for (std::int32_t i = first[b]; i < first[b + 1]; ++i) {
        const ContactRecord& record = records[static_cast<std::size_t>(i)];
        const std::size_t at = static_cast<std::size_t>(list[b]) * BLOCK_NODES +
                               static_cast<std::size_t>(CONTACT_NODE(record.place)) +
                               static_cast<std::size_t>(CONTACT_FIELD(record.place)) * count;
        double gain = 0;
        for (int a = 0; a < 3; ++a)
          // Work on a node: its change of momentum times its mean velocity over the step.
          gain += static_cast<double>(record.mass) *
                  (static_cast<double>(record.after[a]) - static_cast<double>(record.before[a])) *
                  0.5 * (nodes_[at].v[a] + after[at][a]);
        got += gain;
        if (CONTACT_EDGE(record.place) != 0) edge_got += gain;
      }
  }
  account_.tools += work;
  account_.edge += edge_work - edge_got;
  account_.contact += work - edge_work - (got - edge_got);
}

void EnergyLedger::begin_step(const ParticleStore& store, bool hold) {
  // The law runs within the step, so the ledger keeps a copy of all particles.
  before_ = words_of(store);
  if (hold) return;
  // The previous transfer has ended. What nodes had and particles did not take up is lost; then
  // soil came and went.
  const double moving = moving_energy(store, before_), elastic = elastic_energy(store, before_);
  account_.transfer += account_.kinetic - moving_;
  account_.exchanged += moving - moving_ + elastic - account_.elastic;
  account_.kinetic = moving;
}

void EnergyLedger::end_step(const ParticleStore& store, Transfer& transfer, Contact& contact,
                            double dt, bool hold, std::span<const ToolMotion> motions,
                            std::span<const ToolImpulse> impulses) {
  // A transfer that was open when the account was opened.
  if (hold && nodes_.empty()) return;
  const Words now = words_of(store);
  record_law(store, now, dt);
  if (!hold) {
    scatter(store, now, contact);
    account_.transfer += account_.kinetic - nodes_energy();
  }
  const std::vector<Vec3> after = velocities(transfer, contact);
  record_tools(contact, after, motions, impulses);
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    // Gravity acts on the nodes, with their mean velocity over the step.
    account_.gravity += dt * nodes_[i].mass * gravity_.dot(0.5 * (nodes_[i].v + after[i]));
    nodes_[i].v = after[i];
  }
  account_.kinetic = nodes_energy();
  account_.elastic = elastic_energy(store, now);
  moving_ = moving_energy(store, now);
}

}  // namespace navvy::soil
