// SPDX-License-Identifier: Apache-2.0
// The soil of a world as a beam of light meets it: a surface, and lumps above it.
#pragma once

#include <memory>
#include <vector>

#include "core/math.h"
#include "heightfield/terrain_view.h"
#include "sim/world.h"

namespace navvy::sim {

/// A soil particle that is not part of the ground's surface: in the air, or in a bucket or bed. It
/// counts as a ball of the particle's volume.
struct SoilBall {
  Eigen::Vector3f p_O = Eigen::Vector3f::Zero();  ///< centre, relative to VisibleSoil::origin [m]
  float radius = 0;                               ///< radius [m]
};

/// The soil of a world at one instant: each particle is part of the surface or a ball.
///
/// An update passes over the particles once and sorts those near the ground by their columns;
/// memory is kept between updates. Surface and set of balls do not depend on the order in which
/// particles are stored.
class VisibleSoil {
 public:
  /// Prepares for `world`, which must outlive this object. Call `update` before reading.
  explicit VisibleSoil(const World& world);
  ~VisibleSoil();
  VisibleSoil(const VisibleSoil&) = delete;
  VisibleSoil& operator=(const VisibleSoil&) = delete;

  /// Takes the present soil of the world.
  void update();
  /// Returns the columns with the loose soil that rests on them.
  const heightfield::TerrainView& surface() const;
  /// Returns the point in W that the balls count from [m].
  const Vec3& origin() const;
  /// Returns the particles above the surface, by column.
  const std::vector<SoilBall>& balls() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace navvy::sim
