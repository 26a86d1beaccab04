// SPDX-License-Identifier: Apache-2.0
// The surface an operator looks at.
#pragma once

#include "heightfield/layered_ground.h"
#include "heightfield/terrain_view.h"

namespace navvy::control {

/// Where an operator's eyes get the terrain from. Who implements it decides which surface that is,
/// and may take its view when it is first asked in a step: most steps look at nothing.
class SurfaceView {
 public:
  virtual ~SurfaceView() = default;
  /// What can be seen from the cab now; valid until the world steps on.
  virtual const heightfield::Terrain& terrain() const = 0;
  /// The same instant as maps have it, without what buckets and beds hold; stays as it is. For
  /// planners.
  virtual heightfield::TerrainView mapped() const = 0;
  /// Its height at W (x, y) [m].
  double height(double x, double y) const { return terrain().sample(x, y); }
};

/// The resting columns of a ground that is at hand.
class GroundSurfaceView final : public SurfaceView {
 public:
  /// `ground` must outlive it.
  explicit GroundSurfaceView(const heightfield::Ground& ground) : ground_(ground) {}
  const heightfield::Terrain& terrain() const override { return ground_; }
  heightfield::TerrainView mapped() const override { return ground_.view(); }

 private:
  const heightfield::Ground& ground_;
};

}  // namespace navvy::control
