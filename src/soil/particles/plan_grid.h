// SPDX-License-Identifier: Apache-2.0
// Position of blocks among the columns of the site.
#pragma once

#include <cmath>
#include <utility>

#include "heightfield/layered_ground.h"
#include "scene/scene.h"
#include "soil/particles/particle.h"

namespace navvy::soil {

/// Key of a column or of a 4 x 4 block of columns as (y, x). Maps iterate in the order of the
/// ground, x fastest.
using PlanKey = std::pair<int, int>;

/// Column (x, y) of the site lies at the origin of the grid frame G (particle.h) and begins a
/// block. Both are less than a block's side. They are chosen so that the first machine starts at
/// the same offset in its block wherever it stands: the same dig some columns away is then
/// bit-identical.
///
/// Example: with x = 3, columns 3 .. 6 form block 0 along x, and columns -1 .. 2 would form block
/// -1. Blocks at the site's edge may therefore be cut.
struct PlanGrid {
  /// Column at the origin of G.
  int x = 0, y = 0;

  /// Returns the block that holds column (ix, iy).
  PlanKey block_of(int ix, int iy) const {
    const auto down = [](int i) {
      return i >= 0 ? i / kBlockCells : -((kBlockCells - 1 - i) / kBlockCells);
    };
    return {down(iy - y), down(ix - x)};
  }
  /// Return the position of column c of a block, 0 .. 15, x fastest.
  int column_x(const PlanKey& block, int c) const {
    return x + kBlockCells * block.second + c % kBlockCells;
  }
  int column_y(const PlanKey& block, int c) const {
    return y + kBlockCells * block.first + c / kBlockCells;
  }
  /// Returns the column below a particle, (ix, iy).
  std::pair<int, int> column_of(const Particle& p) const {
    const auto cell = [&](int a) {
      return kBlockCells * p.block[a] + static_cast<int>(std::floor(p.x[a]));
    };
    return {x + cell(0), y + cell(1)};
  }
  /// Returns the index of a column in its block, 0 .. 15.
  int place(int ix, int iy) const {
    const PlanKey block = block_of(ix, iy);
    return (iy - column_y(block, 0)) * kBlockCells + ix - column_x(block, 0);
  }
};

/// Returns the position of blocks for a world: 0 without machines.
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
