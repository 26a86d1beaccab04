// SPDX-License-Identifier: Apache-2.0
// Access to the ground surface that an operator sees.
#pragma once

#include <utility>

#include "heightfield/layered_ground.h"
#include "heightfield/terrain_view.h"

namespace navvy::control {

/// Gives an operator access to the terrain surface. The implementation decides which surface that
/// is (with or without loose soil). It may compute the surface on the first request in a step,
/// since in most steps nobody requests it.
class SurfaceView {
 public:
  virtual ~SurfaceView() = default;
  /// Returns the surface as seen from the cab in this step. The reference is valid until the world
  /// takes its next step.
  virtual const heightfield::Terrain& terrain() const = 0;
  /// Returns an immutable copy of the surface for path planners. It shows the same instant as
  /// `terrain`, but without the soil in buckets and beds, as maps do.
  virtual heightfield::TerrainView mapped() const = 0;
  /// Returns the surface height in W [m] at the point (x, y) [m] in W.
  double height(double x, double y) const { return terrain().sample(x, y); }
};

/// Shows the resting ground only, without loose soil particles.
class GroundSurfaceView final : public SurfaceView {
 public:
  /// Stores a reference to `ground`, which must outlive this view.
  explicit GroundSurfaceView(const heightfield::Ground& ground) : ground_(ground) {}
  /// Returns the ground itself.
  const heightfield::Terrain& terrain() const override { return ground_; }
  /// Returns an immutable copy of the ground.
  heightfield::TerrainView mapped() const override { return ground_.view(); }

 private:
  // The ground that is shown.
  const heightfield::Ground& ground_;
};

/// Shows another surface with bodies on it, for checks before a run.
class OccupiedSurfaceView final : public SurfaceView {
 public:
  /// Stores a reference to `surface`, which must outlive this view.
  OccupiedSurfaceView(const SurfaceView& surface, heightfield::OccupiedAreas areas)
      : surface_(surface), areas_(std::move(areas)) {}
  /// Returns the terrain of the other surface.
  const heightfield::Terrain& terrain() const override { return surface_.terrain(); }
  /// Returns an immutable copy of the other surface, on which bodies occupy the areas.
  heightfield::TerrainView mapped() const override { return surface_.mapped().with(areas_); }

 private:
  // The surface that is shown, and the areas of the bodies on it.
  const SurfaceView& surface_;
  heightfield::OccupiedAreas areas_;
};

}  // namespace navvy::control
