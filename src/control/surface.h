// SPDX-License-Identifier: Apache-2.0
// The surface an operator looks at.
#pragma once

#include "heightfield/terrain.h"

namespace navvy::control {

/// Where an operator's eyes get the terrain from. Who implements it decides which surface that is, and may take its
/// view when it is first asked in a step: most steps look at nothing.
class SurfaceView {
 public:
  virtual ~SurfaceView() = default;
  /// What can be seen from the cab now; valid until the world steps on.
  virtual const heightfield::Terrain& terrain() const = 0;
  /// Its height at W (x, y) [m].
  double height(double x, double y) const { return terrain().sample(x, y); }
};

/// A terrain that is at hand: a ground's resting columns, or a view.
class GroundSurface final : public SurfaceView {
 public:
  /// `terrain` must outlive it.
  explicit GroundSurface(const heightfield::Terrain& terrain) : terrain_(terrain) {}
  const heightfield::Terrain& terrain() const override { return terrain_; }

 private:
  const heightfield::Terrain& terrain_;
};

}  // namespace navvy::control
