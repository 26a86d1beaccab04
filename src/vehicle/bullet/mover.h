// SPDX-License-Identifier: Apache-2.0
// Obstacle: a machine that another engine moves. It pushes, and nothing moves it.
#pragma once

#include <memory>
#include <vector>

#include "vehicle/bullet/bullet_machine.h"

namespace navvy::vehicle {

/// Represents each link with collision shapes or a shell by a fixed body with a prescribed pose and
/// velocity: a moving wall to contacts. Its wheels push nothing, since tyres are forces, and it
/// receives none.
class Mover {
 public:
  /// Builds the bodies.
  /// @throws InputError, FileError for shapes that cannot be built.
  explicit Mover(const scene::Machine& machine);

  /// Returns one fixed body per link with shapes.
  const std::vector<std::unique_ptr<BulletMachine>>& bodies() const { return bodies_; }
  /// Moves the bodies to these poses with these velocities, by link of the machine. A body at rest
  /// wakes no other body.
  void move(const std::vector<LinkState>& links);

 private:
  std::vector<std::unique_ptr<BulletMachine>> bodies_;
  std::vector<std::size_t> link_;  // link of each body
};

}  // namespace navvy::vehicle
