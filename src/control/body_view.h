// SPDX-License-Identifier: Apache-2.0
// Loose bodies, such as stones, as an operator sees them.
#pragma once

#include <string>

#include "core/math.h"

namespace navvy::control {

/// A loose body, such as a stone: one link that forces move, without joints, drive or program.
struct BodyView {
  /// Name of the body in the scene.
  std::string name;
  /// Middle of the box around the body's shapes, in W [m].
  Vec3 centre = Vec3::Zero();
  /// Largest and smallest side of that box [m].
  double largest = 0, smallest = 0;
  /// Mass [kg].
  double mass = 0;
  /// Speed of the body's origin [m/s].
  double speed = 0;
  /// True if the body has a shell, with which loose soil carries it.
  bool has_shell = true;

  /// Returns half of the largest side [m].
  double radius() const { return 0.5 * largest; }
  /// Returns a height in W [m] above which the body does not reach however it lies.
  double top() const { return centre.z() + radius(); }
  /// Returns the highest possible height in W of the body's lowest point [m].
  double bottom() const { return centre.z() - 0.5 * smallest; }
};

}  // namespace navvy::control
