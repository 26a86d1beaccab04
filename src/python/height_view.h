// SPDX-License-Identifier: Apache-2.0
// The heights of a site as one array at a stable address.
#pragma once

#include <memory>
#include <vector>

#include "heightfield/change_follower.h"
#include "heightfield/terrain_view.h"

namespace navvy::python {

/// Heights [m] of a site as world z, row after row from the smallest y on, x fastest. The array is
/// allocated once and never moves while the site keeps its size; an update writes changed columns
/// only.
class HeightView {
 public:
  /// Brings the array up to date with `view`. Returns the rectangles that it has written.
  std::vector<heightfield::CellRect> update(const heightfield::TerrainView& view);
  /// Makes the next update write the whole site, as after a change of the world.
  void forget() { follower_.forget(); }
  /// Returns the array, which readers may keep alive beyond the world; null before `update`.
  const std::shared_ptr<std::vector<float>>& values() const { return values_; }
  /// Returns the number of columns along x and y at the last update.
  int nx() const { return nx_; }
  int ny() const { return ny_; }

 private:
  heightfield::ChangeFollower follower_;
  std::shared_ptr<std::vector<float>> values_;
  /// Heights of one rectangle; a member, so that an update allocates nothing.
  std::vector<float> part_;
  int nx_ = 0, ny_ = 0;
};

}  // namespace navvy::python
