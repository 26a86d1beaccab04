// SPDX-License-Identifier: Apache-2.0
// Initial surface of a site that a scene describes by shapes.
#pragma once

#include <vector>

#include "heightfield/layered_ground.h"
#include "scene/ground.h"

namespace navvy::heightfield {

/// The initial ground as the sum of a base height and shapes such as hills and trenches. It is a
/// pure function of position, so the order of queries does not matter.
///
/// A slope rises along its yaw direction. Hills are two octaves of value noise within +- height /
/// 2. A trench has a floor of length x width, and walls that lean outwards by `angle` from the
/// vertical. A bank rises to the left of the line through its centre along yaw, at `angle` from the
/// horizontal (0 or 90 deg: vertical). A stockpile is a cone. A block is a rectangle of constant
/// height.
class ProceduralSurface {
 public:
  /// Copies the shapes of `ground`. `friction_angle` [rad] is the slope of stockpiles that give no
  /// angle of their own.
  ProceduralSurface(const scene::StartGround& ground, double friction_angle);

  /// Returns the world z of the surface at world position (x, y) [m].
  double operator()(double x, double y) const;
  /// Returns a lower bound of the surface height within the world rectangle from `min` to `max`
  /// [m]. The bound is exact for a single shape that lies within the rectangle, except for hills.
  double lower_bound(const Vec2& min, const Vec2& max) const;

 private:
  /// Height of the ground without shapes, as world z [m].
  double base_;
  /// Slope of stockpiles for which the scene gives no angle [rad].
  double friction_angle_;
  /// Shapes of the ground, whose heights are added up in this order.
  std::vector<scene::GroundFeature> features_;
};

}  // namespace navvy::heightfield
