// SPDX-License-Identifier: Apache-2.0
// Who keeps a copy of the terrain and renews only what changed.
#pragma once

#include <optional>
#include <vector>

#include "heightfield/terrain_view.h"

namespace navvy::heightfield {

/// Tells one client what changed between the views it was shown. One per client; it keeps the last
/// view.
///
/// Two views are compared by the tiles they share, so the answer needs no cursor and is as right
/// after a snapshot was loaded, after a long pause or from one `Surface` to the other as it is from
/// step to step. Costs about 1 us, and 3 to 6 us a tile that was written to in between.
class ChangeFollower {
 public:
  /// Rectangles, at most RectList::kMost, that hold every column whose height, soil, density state
  /// or loose depth differs from the view of the last call; empty when there is none. The whole
  /// site the first time and for a view of another site. May tell some columns that did not change,
  /// where many rectangles were united.
  std::vector<CellRect> take(const TerrainView& view);
  /// Makes the next answer the whole site.
  void forget() { seen_.reset(); }

 private:
  std::optional<TerrainView> seen_;
};

}  // namespace navvy::heightfield
