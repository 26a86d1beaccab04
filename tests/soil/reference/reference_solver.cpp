// SPDX-License-Identifier: Apache-2.0
#include "soil/reference/reference_solver.h"

#include <algorithm>
#include <cmath>

#include "soil/host_law/double_contact.h"
#include "soil/particles/floor.h"
#include "soil/reference/law_soil.h"

namespace navvy::soil::reference {
namespace {

/// Base node, offset from it and the three weights along each axis.
struct Weights {
  std::array<int, 3> base{};
  Vec3 f;
  std::array<std::array<double, 3>, 3> w{};
};

Weights weights_at(const Vec3& x) {
  Weights out;
  for (int a = 0; a < 3; ++a) {
    const auto i = static_cast<std::size_t>(a);
    out.base[i] = static_cast<int>(std::floor(x[a] - 0.5));
    out.f[a] = x[a] - out.base[i];
    spline(out.f[a], out.w[i].data());
  }
  return out;
}

/// Calls visit(node, weight, node - base) for the 27 nodes around a point.
template <class Visit>
void for_nodes(const Weights& at, const Visit& visit) {
  for (int k = 0; k < 3; ++k)
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i) {
        const double w = at.w[0][static_cast<std::size_t>(i)] *
                         at.w[1][static_cast<std::size_t>(j)] *
                         at.w[2][static_cast<std::size_t>(k)];
        visit(std::array<int, 3>{at.base[0] + i, at.base[1] + j, at.base[2] + k}, w, Vec3(i, j, k));
      }
}

}  // namespace

// By the list of fields, so that the twin never lacks one.
Point from_particle(const Particle& particle) {
  Point p;
#define FROM_ONE(NAME, member, rest) p.member = static_cast<double>(particle.member);
#define FROM_MANY(NAME, member, count, rest) \
  for (int k = 0; k < (count); ++k) p.member[k] = static_cast<double>(particle.member[k]);
  FLOAT_FIELDS(FROM_ONE, FROM_MANY)
#undef FROM_ONE
#undef FROM_MANY
  for (int a = 0; a < 3; ++a) {
    p.x[a] += kBlockCells * particle.block[a];
    p.block[static_cast<std::size_t>(a)] =
        static_cast<int>(std::floor(std::floor(p.x[a] - 0.5) / kBlockCells));
    p.x[a] += p.moved[a];
  }
  p.mass = kilograms(particle.mass);
  p.soil = particle.soil;
  return p;
}

ReferenceSolver::ReferenceSolver(std::vector<scene::Soil> soils, double cell, const Vec3& gravity,
                                 std::function<double(int, int)> ground)
    : soils_(std::move(soils)), cell_(cell), gravity_(gravity), ground_(std::move(ground)) {
  double fastest = 0;
  for (const scene::Soil& soil : soils_) fastest = std::max(fastest, sound_speed(soil));
  transfer_length_ = kScheme.transfer_length * cell_ / fastest;
}

std::vector<double> ReferenceSolver::openings() const {
  // Sums per cell of base nodes, in mass quanta as in the kernels.
  struct Cell {
    double volume = 0, bank = 0, open = 0;
  };
  std::map<std::array<int, 6>, Cell> cells;
  const auto key = [](const Point& p) {
    const Weights at = weights_at(p.x - p.moved);
    return std::array<int, 6>{p.block[0], p.block[1], p.block[2],
                              at.base[0], at.base[1], at.base[2]};
  };
  for (const Point& p : points) {
    Cell& cell = cells[key(p)];
    cell.volume += p.mass / kMassQuantum * p.j;
    cell.bank += p.mass / kMassQuantum * p.j0;
    cell.open += p.j > p.j0 ? 1 : 0;
  }
  std::vector<double> out;
  for (const Point& p : points) {
    const Cell& cell = cells.at(key(p));
    out.push_back(mean_opening(cell.volume, cell.bank, cell.open));
  }
  return out;
}

void ReferenceSolver::scatter(double dt, bool hold) {
  // All openings first: mixing compares particles as the step found them.
  const std::vector<double> opening = openings();
  const double mixing = dt / kScheme.mixing_strain, most = most_mixing(dt);
  if (!hold) nodes_.clear();
  for (auto& [at, node] : nodes_) {
    node.mass = 0;
    node.momentum.setZero();
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    Point& p = points[i];
    const scene::Soil& soil = soils_.at(static_cast<std::size_t>(p.soil));
    const LawSoil law = law_soil(soil, cell_);
    double sigma[6], start[3], a[9];
    advance_state(p.c, dt, &law, opening[i], mixing, most, &p, sigma);
    const Weights weights = weights_at(p.x - p.moved);
    affine_momentum(p.c, sigma, p.v.data(), weights.f.data(), p.mass, p.mass / soil.bank_density,
                    p.j, hold ? 0 : 1, dt, cell_, start, a);
    // Momentum is linear around a particle: a node has that at the base node and its change over
    // the way there.
    const Vec3 base(start[0], start[1], start[2]);
    const Mat3 change = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(a);
    for_nodes(weights, [&](const std::array<int, 3>& at, double w, const Vec3& place) {
      Node& node = nodes_[at];
      node.mass += w * p.mass;
      node.momentum += w * (base + change * place);
    });
  }
}

void ReferenceSolver::update_grid(double dt, bool hold) {
  for (auto& [at, node] : nodes_) {
    const double above = at[2] - ground_(at[0], at[1]);
    // A node lighter than a mass quantum is empty, as in the kernels.
    const bool empty = node.mass <= kMassQuantum, fixed = above <= kScheme.held_margin;
    const Vec3 before = hold ? node.velocity : Vec3(Vec3::Zero());
    node.velocity = Vec3::Zero();
    if (!empty) node.velocity = before + node.momentum * INVERSE_MASS(node.mass) + gravity_ * dt;
    if (fixed) {
      // The topmost held node lets soil fall that is not on the ground yet, but near a tool.
      const auto next = nodes_.find({at[0], at[1], at[2] + 1});
      const double mass_above = next == nodes_.end() ? 0 : next->second.mass;
      const bool topmost = !contact && above + 1 > kScheme.held_margin;
      const double falls = topmost ? falling_share(node.mass, mass_above, above) : 0;
      node.velocity = Vec3(0, 0, std::min(node.velocity.z(), 0.0) * falls);
    }
    if (contact && !empty && !fixed)
      node.velocity += contact(at, node.mass, node.velocity) / node.mass;
    // Particles gather their local density from this mass.
    node.free_fraction_mass = node.mass / free_fraction_above(above);
  }
}

void ReferenceSolver::gather(double dt) {
  // Crowding is judged by the densest soil of the scene, see packed_mass.
  double densest = 0;
  for (const scene::Soil& soil : soils_) densest = std::max(densest, soil.bank_density);
  const double full = packed_mass(densest, cell_), filled = filled_mass(densest, cell_),
               spread = dt / kScheme.crowding_strain;
  const double closing = kScheme.closing_share * std::min(1.0, dt / transfer_length_);
  const double most = kScheme.max_crowding_displacement * std::min(1.0, dt / transfer_length_);
  fastest_ = 0;
  for (Point& p : points) {
    Vec3 v = Vec3::Zero(), lean = Vec3::Zero();
    Mat3 moment = Mat3::Zero();
    double mass = 0;
    const Weights weights = weights_at(p.x - p.moved);
    for_nodes(weights, [&](const std::array<int, 3>& at, double w, const Vec3& place) {
      const Node& node = nodes_.at(at);
      mass += w * node.free_fraction_mass;
      lean += w * node.free_fraction_mass * (place - weights.f);
      v += w * node.velocity;
      moment += w * node.velocity * place.transpose();
    });
    for (int i = 0; i < 3; ++i)
      for (int axis = 0; axis < 3; ++axis)
        p.c[3 * i + axis] = velocity_gradient(moment(i, axis), weights.f[axis], v[i], cell_);
    p.v = v;
    Vec3 way = (dt / cell_) * v;
    const double share = crowding(p.c, p.j, p.j0, mass, full, spread);
    p.j = close_noise(p.j, p.j0, mass, filled, closing);
    for (int axis = 0; axis < 3; ++axis)
      way[axis] += crowding_displacement(share, lean[axis], mass, most);
    p.x += way;
    p.moved += way;
    fastest_ = std::max(fastest_, way.cwiseAbs().maxCoeff() * cell_ / dt);
  }
}

void ReferenceSolver::step(double dt) {
  const bool hold = interval_.holds(dt, transfer_length_, cell_, 0, gravity_.norm());
  if (!hold) {
    interval_ = {};
    for (Point& p : points) p.moved.setZero();
  }
  scatter(dt, hold);
  update_grid(dt, hold);
  gather(dt);
  interval_.count_step(dt, cell_, fastest_, 0);
}

Vec3 ReferenceSolver::momentum() const {
  Vec3 sum = Vec3::Zero();
  for (const Point& p : points) sum += p.mass * p.v;
  return sum;
}

}  // namespace navvy::soil::reference
