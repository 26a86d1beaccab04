// SPDX-License-Identifier: Apache-2.0
// Finds the columns in which two views of a terrain differ.
#pragma once

#include <optional>
#include <vector>

#include "heightfield/terrain_view.h"

namespace navvy::heightfield {

/// Reports to one client which columns of a terrain changed since the client's last call. Each
/// client has its own follower, which stores the view that the client passed last.
///
/// The follower compares the tiles of the stored view with those of the new view, and skips tiles
/// that both share. The result is therefore also correct after a snapshot was loaded, after a long
/// pause, or if the client switches to another SurfaceKind. A call takes about 1 us, plus 3 to 6 us
/// for each tile written between the two views.
class ChangeFollower {
 public:
  /// Returns the columns in which `view` differs from the view of the last call, and stores `view`
  /// for the next call.
  ///
  /// The result consists of at most RectList::kMost rectangles. They cover every column whose
  /// height, surface soil, density state or loose depth differs, and may also cover unchanged
  /// columns. The result is empty if nothing differs. It is the whole site at the first call and
  /// for a view of another site.
  std::vector<CellRect> take(const TerrainView& view);
  /// Discards the stored view, so that the next call of `take` returns the whole site.
  void forget() { seen_.reset(); }

 private:
  /// View passed to the last call of `take`; empty before the first call and after `forget`.
  std::optional<TerrainView> seen_;
};

}  // namespace navvy::heightfield
