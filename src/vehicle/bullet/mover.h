// SPDX-License-Identifier: Apache-2.0
// Obstacle in the Bullet engine: a machine that another engine moves. It pushes other bodies, and
// no force moves it.
#pragma once

#include <memory>
#include <vector>

#include "vehicle/bullet/bullet_machine.h"

namespace navvy::vehicle {

/// Represents each link of an obstacle that has collision shapes or a shell by a fixed body with a
/// prescribed pose and velocity, which acts like a moving wall. The obstacle's wheels push nothing,
/// since tyres are modelled as forces.
class Mover {
 public:
  /// Builds the fixed bodies for `machine`.
  /// @throws InputError, FileError for collision shapes that cannot be built.
  explicit Mover(const scene::Machine& machine);

  /// Returns the fixed bodies, one per link with collision shapes or a shell.
  const std::vector<std::unique_ptr<BulletMachine>>& bodies() const { return bodies_; }
  /// Returns the index of the link that the fixed body with the index `body` represents.
  int link(std::size_t body) const { return static_cast<int>(link_.at(body)); }
  /// Moves the bodies to the poses and velocities in `links`, which has one entry per link of the
  /// obstacle. A body with zero velocity wakes no other body.
  void move(const std::vector<LinkState>& links);

 private:
  /// Fixed bodies of the obstacle.
  std::vector<std::unique_ptr<BulletMachine>> bodies_;
  /// Link index of each fixed body.
  std::vector<std::size_t> link_;
};

}  // namespace navvy::vehicle
