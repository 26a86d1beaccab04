// SPDX-License-Identifier: Apache-2.0
// The terrain at one instant, as an immutable copy.
#pragma once

#include <utility>

#include "heightfield/loose_soil.h"
#include "heightfield/occupied_area.h"
#include "heightfield/terrain.h"

namespace navvy::heightfield {

class Ground;

/// An immutable copy of a ground's surface at one instant, made by Ground::view. Any number of
/// threads may read it while the ground changes, and it may outlive the ground.
///
/// It shares its tiles with the ground and with other views. Copying a view therefore takes
/// microseconds, and storing one takes 14 KiB for each tile that changed since.
class TerrainView final : public Terrain {
 public:
  /// Returns the simulated time of this view [s].
  double time() const { return time_; }
  /// Returns which surface the heights describe: with or without loose soil.
  SurfaceKind surface() const { return surface_; }

  /// Returns a copy of this view with `loose` soil added. In columns with loose soil, height,
  /// surface soil and density state are those of the loose soil. `surface` labels the result
  /// (TerrainView::surface); it does not filter `loose`. Copies each tile that has loose soil.
  TerrainView with(const LooseSoil& loose, SurfaceKind surface = SurfaceKind::kWithLooseSoil) const;

  /// Returns a copy of this view on which bodies occupy `areas`. Heights do not change.
  TerrainView with(OccupiedAreas areas) const {
    TerrainView out = *this;
    out.occupied_ = std::move(areas);
    return out;
  }
  /// Returns the areas that bodies occupy; null if the view knows no bodies.
  const OccupiedAreas& occupied() const { return occupied_; }

 private:
  friend class Ground;
  /// Copies the surface of `terrain` and labels it with simulated time `time` [s].
  TerrainView(const Terrain& terrain, double time) : Terrain(terrain), time_(time) {}
  /// Simulated time of this view [s].
  double time_;
  /// Surface that the heights describe: with or without loose soil.
  SurfaceKind surface_ = SurfaceKind::kColumns;
  /// Areas that bodies occupy; may be null.
  OccupiedAreas occupied_;
};

}  // namespace navvy::heightfield
