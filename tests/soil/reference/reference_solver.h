// SPDX-License-Identifier: Apache-2.0
// The particle method in doubles and plain loops, written to be read: what the kernels must agree
// with.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <vector>

#include "core/math.h"
#include "scene/soil.h"
#include "soil/host_law/double_law.h"
#include "soil/particles/interval.h"
#include "soil/particles/particle.h"

namespace navvy::soil::reference {

/// One particle in doubles, with the law's state and what moves it; fields as in
/// kernels/soil/particle_fields.h, but for its position, which counts in cells of the grid frame G
/// and is that of now: `moved` of it is the way since the last transfer.
struct Point : LawState {
  Point() : LawState{} {}
  Vec3 x = Vec3::Zero(), v = Vec3::Zero();
  double c[9] = {0, 0, 0, 0, 0, 0, 0, 0, 0};
  Vec3 moved = Vec3::Zero();
  double mass = 0;  ///< [kg]
  int soil = 0;
  /// Block of the base node floor(x - 0.5) when the point was made. It does not change. Mixing in
  /// a cell only includes points of one block, as in the kernels, which sort anew.
  std::array<int, 3> block{};
};

Point from_particle(const Particle& particle);

/// MLS-MPM with quadratic B-splines [Hu 2018], APIC, the law of kernels/soil/law.h. Several steps
/// are one transfer, as in the kernels [docs/soil.md, transfer]. No tools of its own. Slow: a map
/// from node to momentum.
class ReferenceSolver {
 public:
  /// `ground(i, j)`: height of the resting ground around node column (i, j) [cells]; nodes up to
  /// held_margin of the scheme above it are fixed.
  ReferenceSolver(std::vector<scene::Soil> soils, double cell, const Vec3& gravity,
                  std::function<double(int, int)> ground);

  std::vector<Point> points;
  /// Impulse of a tool on the node `at` [N s], from its mass [kg] and velocity after gravity [m/s];
  /// may be empty. All soil must lie on one side of the tool.
  std::function<Vec3(const std::array<int, 3>& at, double mass, const Vec3& v)> contact;

  void step(double dt);

  Vec3 momentum() const;

 private:
  /// Mean opening of each point's cell, 0 where none of it is open.
  std::vector<double> openings() const;
  // `hold`: the step goes on with the transfer under way.
  /// Mixing and law, then mass and momentum to the nodes; held, of the momentum only what stress
  /// gives.
  void scatter(double dt, bool hold);
  /// Velocity (held, on top of the node's own), gravity, contact, resting ground; a node lighter
  /// than a quantum is empty.
  void update_grid(double dt, bool hold);
  void gather(double dt);  ///< back to the points, which move
  struct Node {
    double mass = 0, free_fraction_mass = 0;
    Vec3 momentum = Vec3::Zero(), velocity = Vec3::Zero();
  };
  std::vector<scene::Soil> soils_;
  double cell_;
  double transfer_length_;  ///< of one transfer [s]
  TransferInterval interval_;
  double fastest_ = 0;  ///< component of the ways in the last step [m/s]
  Vec3 gravity_;
  std::function<double(int, int)> ground_;
  std::map<std::array<int, 3>, Node> nodes_;
};

}  // namespace navvy::soil::reference
