// SPDX-License-Identifier: Apache-2.0
// The terrain of one instant, which never changes.
#pragma once

#include "heightfield/loose_soil.h"
#include "heightfield/terrain.h"

namespace navvy::heightfield {

class Ground;

/// A copy of a ground's surface at one instant, for any number of threads to read while the ground
/// goes on changing.
///
/// Taken by `Ground::view`. It shares its tiles with the ground and with other views, so copying
/// one costs microseconds and keeping one costs the tiles that changed since (14 KiB each). May
/// outlive the ground.
class TerrainView final : public Terrain {
 public:
  double time() const { return time_; }             ///< [s], as told when it was taken
  SurfaceKind surface() const { return surface_; }  ///< what its heights are those of

  /// The same instant as one sees it: height, soil and density state are those of the loose soil
  /// where some lies. Costs a copy of every tile on which there is any. `surface` says which of the
  /// loose soil was handed in.
  TerrainView with(const LooseSoil& loose, SurfaceKind surface = SurfaceKind::kWithLooseSoil) const;

 private:
  friend class Ground;
  TerrainView(const Terrain& terrain, double time) : Terrain(terrain), time_(time) {}
  double time_;
  SurfaceKind surface_ = SurfaceKind::kColumns;
};

}  // namespace navvy::heightfield
