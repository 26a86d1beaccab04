// SPDX-License-Identifier: Apache-2.0
// Offset of the particle blocks relative to the columns of the site.
#pragma once

#include <cmath>
#include <utility>

#include "heightfield/layered_ground.h"
#include "scene/scene.h"
#include "soil/particles/particle.h"

namespace navvy::soil {

/// Key of a column, or of a block of 4 x 4 columns, as the pair (y, x). A map keyed by it is
/// iterated in the order of the ground's columns: x varies fastest.
using PlanKey = std::pair<int, int>;

/// Offset between the site's columns and the grid frame G (particle.h): column (x, y) of the site
/// is at the origin of G and is the lower-left column of a block.
///
/// Both numbers are in 0 .. 3. They are chosen so that the first machine starts at the same
/// position within a block wherever it stands on the site. The same dig a few columns away is then
/// bit-identical.
///
/// Example: with x = 3, columns 3 .. 6 form block 0 along x, and columns -1 .. 2 form block -1.
/// Blocks at the site's edge may therefore be partly outside the site.
struct PlanGrid {
  /// Column at the origin of G, counted from the site's lower-left corner.
  int x = 0, y = 0;

  /// Returns the key of the block that contains column (ix, iy).
  PlanKey block_of(int ix, int iy) const {
    const auto down = [](int i) {
      return i >= 0 ? i / kBlockCells : -((kBlockCells - 1 - i) / kBlockCells);
    };
    return {down(iy - y), down(ix - x)};
  }
  /// Returns the x index of column c of a block; c = 0 .. 15, x varies fastest.
  int column_x(const PlanKey& block, int c) const {
    return x + kBlockCells * block.second + c % kBlockCells;
  }
  /// Returns the y index of column c of a block; c = 0 .. 15, x varies fastest.
  int column_y(const PlanKey& block, int c) const {
    return y + kBlockCells * block.first + c / kBlockCells;
  }
  /// Returns the column (ix, iy) that contains the particle's position in plan.
  std::pair<int, int> column_of(const Particle& p) const {
    const auto cell = [&](int a) {
      return kBlockCells * p.block[a] + static_cast<int>(std::floor(p.x[a]));
    };
    return {x + cell(0), y + cell(1)};
  }
  /// Returns the index c of column (ix, iy) within its block, 0 .. 15, x fastest.
  int place(int ix, int iy) const {
    const PlanKey block = block_of(ix, iy);
    return (iy - column_y(block, 0)) * kBlockCells + ix - column_x(block, 0);
  }
};

/// Returns the offset for a world, from the start position of its first machine; (0, 0) without
/// machines.
inline PlanGrid plan_grid(const scene::Scene& world, const heightfield::Ground& ground) {
  if (world.machines.empty()) return {};
  const Vec3& start = world.machines.front().X_WM.translation();
  // Round numbers lie on the edges of columns. They must round the same way everywhere.
  constexpr double kAside = 0.3;
  const auto within = [&](double at, double corner) {
    const auto column = static_cast<int>(std::floor((at - corner) / ground.cell() + kAside));
    return (column % kBlockCells + kBlockCells) % kBlockCells;
  };
  return {within(start.x(), ground.origin().x()), within(start.y(), ground.origin().y())};
}

}  // namespace navvy::soil
