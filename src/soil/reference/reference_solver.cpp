// SPDX-License-Identifier: Apache-2.0
#include "soil/reference/reference_solver.h"

#include <algorithm>
#include <cmath>

#include "soil/particles/floor.h"
#include "soil/reference/double_law.h"

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
    const double f = x[a] - out.base[i];
    out.f[a] = f;
    out.w[i] = {0.5 * (1.5 - f) * (1.5 - f), 0.75 - (f - 1) * (f - 1), 0.5 * (f - 0.5) * (f - 0.5)};
  }
  return out;
}

template <class Visit>
void for_nodes(const Weights& at, const Visit& visit) {
  for (int k = 0; k < 3; ++k)
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i) {
        const double w = at.w[0][static_cast<std::size_t>(i)] * at.w[1][static_cast<std::size_t>(j)] *
                         at.w[2][static_cast<std::size_t>(k)];
        visit(std::array<int, 3>{at.base[0] + i, at.base[1] + j, at.base[2] + k}, w, Vec3(i, j, k) - at.f);
      }
}

}  // namespace

double kernel_share(double t) {
  const double a = std::clamp(t, -0.5, 0.5), low = std::clamp(1.5 + t, 0.0, 1.0), high = std::clamp(1.5 - t, 0.0, 1.0);
  const double share = 0.5 + a * (0.75 - a * a / 3) + (low * low * low - high * high * high) / 6;
  return std::max(share, 0.25);
}

Point from_particle(const Particle& particle) {
  Point p;
  for (int a = 0; a < 3; ++a) {
    p.x[a] = kBlockCells * particle.block[a] + static_cast<double>(particle.x[a]);
    p.v[a] = static_cast<double>(particle.v[a]);
    for (int b = 0; b < 3; ++b) p.c(a, b) = static_cast<double>(particle.c[3 * a + b]);
  }
  for (std::size_t i = 0; i < 6; ++i) p.s[i] = static_cast<double>(particle.s[i]);
  p.j = static_cast<double>(particle.j);
  p.j0 = static_cast<double>(particle.j0);
  p.shear = static_cast<double>(particle.shear);
  p.mass = kilograms(particle.mass);
  p.soil = particle.soil;
  for (std::size_t a = 0; a < 3; ++a)
    p.home[a] = static_cast<int>(std::floor(std::floor(p.x[static_cast<int>(a)] - 0.5) / kBlockCells));
  return p;
}

ReferenceSolver::ReferenceSolver(std::vector<scene::Soil> soils, double cell, const Vec3& gravity,
                                 std::function<double(int, int)> ground)
    : soils_(std::move(soils)), cell_(cell), gravity_(gravity), ground_(std::move(ground)) {}

void ReferenceSolver::mix(double dt) {
  // In a cell with open soil J / J0 relaxes to the cell's mean; see particle_to_grid.cl.
  struct Cell {
    double volume = 0, closed = 0;
    bool open = false;
  };
  std::map<std::array<int, 6>, Cell> cells;
  const auto key = [](const Point& p) {
    const Weights at = weights_at(p.x);
    return std::array<int, 6>{p.home[0], p.home[1], p.home[2], at.base[0], at.base[1], at.base[2]};
  };
  for (const Point& p : points) {
    Cell& cell = cells[key(p)];
    cell.volume += p.mass * p.j;
    cell.closed += p.mass * p.j0;
    cell.open = cell.open || p.j > p.j0;
  }
  const double share = std::min(1.0, dt / mixing_time());
  for (Point& p : points) {
    const Cell& cell = cells.at(key(p));
    if (cell.open) p.j += share * (p.j0 * cell.volume / cell.closed - p.j);
  }
}

void ReferenceSolver::step(double dt) {
  mix(dt);
  // Stress, then mass and momentum to the nodes.
  nodes_.clear();
  for (Point& p : points) {
    const scene::Soil& soil = soils_.at(static_cast<std::size_t>(p.soil));
    const LawSoil law = law_soil(soil, cell_);
    double c[9], sigma[6];
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) c[3 * a + b] = p.c(a, b);
    law_update(c, dt, &law, p.s.data(), &p.j, &p.j0, &p.shear, sigma);
    Mat3 stress;
    stress << sigma[0], sigma[3], sigma[5], sigma[3], sigma[1], sigma[4], sigma[5], sigma[4], sigma[2];
    const double volume = p.j * p.mass / soil.bank_density;
    const Mat3 affine = p.mass * cell_ * p.c - dt * (4 / cell_) * volume * stress;
    for_nodes(weights_at(p.x), [&](const std::array<int, 3>& at, double w, const Vec3& r) {
      Node& node = nodes_[at];
      node.mass += w * p.mass;
      node.momentum += w * (p.mass * p.v + affine * r);
    });
  }
  // Velocity, gravity, resting ground. A node lighter than a mass quantum is empty.
  for (auto& [at, node] : nodes_) {
    const double above = at[2] - ground_(at[0], at[1]);
    const bool empty = node.mass <= kMassQuantum, fixed = above <= kHeldMargin;
    node.momentum = empty || fixed ? Vec3(Vec3::Zero()) : Vec3(node.momentum / node.mass + gravity_ * dt);
    if (contact && !empty && !fixed) node.momentum += contact(at, node.mass, node.momentum) / node.mass;
    node.mass /= kernel_share(above);
  }
  // Back to the particles; `momentum` of a node is its velocity now.
  double densest = 0;
  for (const scene::Soil& soil : soils_) densest = std::max(densest, soil.bank_density);
  const double packed = packed_mass(densest, cell_), closing = std::min(1.0, dt / closing_time());
  for (Point& p : points) {
    Vec3 v = Vec3::Zero();
    Mat3 moment = Mat3::Zero();
    double mass = 0;
    for_nodes(weights_at(p.x), [&](const std::array<int, 3>& at, double w, const Vec3& r) {
      const Node& node = nodes_.at(at);
      const Vec3& u = node.momentum;
      mass += w * node.mass;
      v += w * u;
      moment += w * u * r.transpose();
    });
    p.j -= closing * std::max(0.0, std::min(p.j, p.j0) - packed / mass);
    p.v = v;
    p.c = (4 / cell_) * moment;
    p.x += (dt / cell_) * v;
  }
}

Vec3 ReferenceSolver::momentum() const {
  Vec3 sum = Vec3::Zero();
  for (const Point& p : points) sum += p.mass * p.v;
  return sum;
}

}  // namespace navvy::soil::reference
