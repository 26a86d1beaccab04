// SPDX-License-Identifier: Apache-2.0
// The surface of a site that a scene describes by shapes.
#pragma once

#include <vector>

#include "heightfield/layered_ground.h"
#include "scene/ground.h"

namespace navvy::heightfield {

/// A flat ground with shapes on it, as a pure function of place: two builds agree in any order of
/// queries.
///
/// Shapes are summed. A slope rises along its yaw. Hills are two octaves of value noise bounded by
/// +- height / 2. The floor of a trench is length x width, and its sides lean outward by `angle`
/// from the vertical. The toe of a bank is the line through its centre along yaw; its face rises to
/// the left at `angle` from the horizontal (0 or 90 deg: vertical).
class ProceduralSurface {
 public:
  /// `friction_angle` [rad] is the slope of stockpiles that give no angle.
  ProceduralSurface(const scene::StartGround& ground, double friction_angle);

  /// Returns the height of the surface at W (x, y) [m].
  double operator()(double x, double y) const;
  /// Returns a height that the surface never falls below inside the rectangle [m]; exact for a
  /// single shape other than hills.
  double lower_bound(const Vec2& min, const Vec2& max) const;

 private:
  double base_;
  double friction_angle_;
  std::vector<scene::GroundFeature> features_;
};

}  // namespace navvy::heightfield
