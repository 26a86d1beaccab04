// SPDX-License-Identifier: Apache-2.0
// The terrain at one instant, which never changes.
#pragma once

#include "heightfield/loose_soil.h"
#include "heightfield/terrain.h"

namespace navvy::heightfield {

class Ground;

/// An immutable copy of a ground's surface at one instant. Any number of threads may read it while
/// the ground changes.
///
/// `Ground::view` makes it. It shares its tiles with the ground and with other views, so that
/// copying one costs microseconds and keeping one costs the tiles that changed since (14 KiB each).
/// It may outlive the ground.
class TerrainView final : public Terrain {
 public:
  /// Returns the time that it was stamped with [s].
  double time() const { return time_; }
  /// Returns the kind of surface that its heights describe.
  SurfaceKind surface() const { return surface_; }

  /// Returns the same instant with loose soil: height, soil and density state are those of the
  /// loose soil where some rests. `surface` says which loose soil was passed in. Costs a copy of
  /// every tile that has any.
  TerrainView with(const LooseSoil& loose, SurfaceKind surface = SurfaceKind::kWithLooseSoil) const;

 private:
  friend class Ground;
  TerrainView(const Terrain& terrain, double time) : Terrain(terrain), time_(time) {}
  double time_;
  SurfaceKind surface_ = SurfaceKind::kColumns;
};

}  // namespace navvy::heightfield
