// SPDX-License-Identifier: Apache-2.0
// The scene of a scan in Bullet, whose ray tests are the yardstick of ours.
#pragma once

#include <memory>

#include "core/math.h"
#include "sim/visible_soil.h"
#include "sim/world.h"

namespace navvy::bench {

/// A btCollisionWorld with the visuals of all machines as triangle meshes, the ground as a height
/// field with its accelerator, and soil above it as spheres. Hydraulic cylinders are left out.
class BulletRays {
 public:
  /// Builds the scene from the present state of `world`.
  BulletRays(const sim::World& world, const sim::VisibleSoil& soil);
  ~BulletRays();

  /// Renews the boxes of all objects, as after a step in which they moved.
  void update();
  /// Returns the distance to the first thing within `reach` [m]; a negative number for none.
  double first_hit(const Vec3& p_W, const Vec3& direction_W, double reach) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace navvy::bench
