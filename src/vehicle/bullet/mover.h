// SPDX-License-Identifier: Apache-2.0
// A machine that another engine moves, as bodies of this one: it pushes, and nothing moves it.
#pragma once

#include <memory>
#include <vector>

#include "vehicle/bullet/bullet_machine.h"

namespace navvy::vehicle {

/// Each link with collision shapes or a shell is a body that stands, of a place and speed that are
/// told step by step: to contacts a wall that moves. Its wheels push nothing: tyres are forces, and
/// it feels none.
class Mover {
 public:
  /// @throws InputError, FileError for shapes that cannot be built.
  explicit Mover(const scene::Machine& machine);

  const std::vector<std::unique_ptr<BulletMachine>>& bodies() const { return bodies_; }
  /// To these places at these speeds, by link of the machine. What does not move wakes nobody.
  void move(const std::vector<LinkState>& links);

 private:
  std::vector<std::unique_ptr<BulletMachine>> bodies_;
  std::vector<std::size_t> link_;  // of each body
};

}  // namespace navvy::vehicle
