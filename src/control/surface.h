// SPDX-License-Identifier: Apache-2.0
// The surface that an operator sees.
#pragma once

#include "heightfield/layered_ground.h"
#include "heightfield/terrain_view.h"

namespace navvy::control {

/// The operator's view of the terrain. The implementation decides which surface that is, and may
/// build the view when it is first asked for in a step, since most steps ask for nothing.
class SurfaceView {
 public:
  virtual ~SurfaceView() = default;
  /// Returns the surface seen from the cab now; valid until the world steps on.
  virtual const heightfield::Terrain& terrain() const = 0;
  /// Returns the same instant as maps show it, without the contents of buckets and beds. The view
  /// is immutable. For planners.
  virtual heightfield::TerrainView mapped() const = 0;
  /// Returns the height at (x, y) [m] in W.
  double height(double x, double y) const { return terrain().sample(x, y); }
};

/// A view of the resting columns of a ground.
class GroundSurfaceView final : public SurfaceView {
 public:
  /// Keeps a reference to `ground`, which must outlive the view.
  explicit GroundSurfaceView(const heightfield::Ground& ground) : ground_(ground) {}
  const heightfield::Terrain& terrain() const override { return ground_; }
  heightfield::TerrainView mapped() const override { return ground_.view(); }

 private:
  const heightfield::Ground& ground_;
};

}  // namespace navvy::control
