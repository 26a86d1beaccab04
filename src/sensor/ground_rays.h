// SPDX-License-Identifier: Apache-2.0
// Beams on the ground, which skip tiles that they pass above.
#pragma once

#include <optional>
#include <vector>

#include "heightfield/change_follower.h"
#include "heightfield/terrain_view.h"

namespace navvy::sensor {

/// The surface of the ground at one instant, as a two-level grid: columns, and the highest point of
/// each tile of kTile x kTile columns, which is found when a beam first needs it.
class GroundRays {
 public:
  /// Columns along one side of a tile; tuned: bench scan of 361 beams.
  static constexpr int kTile = 16;

  /// Replaces the surface. Tiles without a change keep their highest point.
  void update(const heightfield::TerrainView& surface);
  /// Returns the distance at which a beam from `p_W` along the unit vector `direction_W` meets the
  /// surface within `reach` [m]; 0 below the surface. The ground ends at the edges of the site.
  std::optional<double> first_hit(const Vec3& p_W, const Vec3& direction_W, double reach) const;
  /// Returns the surface.
  const heightfield::TerrainView& surface() const { return *surface_; }

 private:
  /// Returns the highest point of a tile, with the columns around it [m].
  double highest(int tx, int ty) const;

  std::optional<heightfield::TerrainView> surface_;  ///< empty before the first update
  heightfield::ChangeFollower changes_;
  int nx_ = 0, ny_ = 0;  ///< number of tiles
  /// Highest point of each tile [m]; NaN: not known yet.
  mutable std::vector<double> highest_;
};

}  // namespace navvy::sensor
