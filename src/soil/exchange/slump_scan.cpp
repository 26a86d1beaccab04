// SPDX-License-Identifier: Apache-2.0
#include "soil/exchange/slump_scan.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>

#include "core/archive.h"

namespace navvy::soil {
namespace {

/// A drop must have grown by this since the start to count on ground that holds [cells]. Tuned:
/// above the rounding of mass quanta and float heights, below the shallowest rut that matters.
constexpr double kGrown = 0.01;
/// The same where the low side is active: the position of its highest particle jumps by half a
/// cell.
constexpr double kGrownActive = 0.5;
// Both directions along axes and diagonals, in which columns lie at whole steps.
constexpr int kDirections[8][2] = {{1, 0}, {-1, 0},  {0, 1},  {0, -1},
                                   {1, 1}, {-1, -1}, {1, -1}, {-1, 1}};
/// Drops below their limit by more than this are left out by a test in floats [cells]: it is far
/// above the rounding of drops near a limit.
constexpr float kRounding = 1e-3F;

}  // namespace

void StandingHeights::remember(const heightfield::Ground& ground, const ColumnIndex& index,
                               const std::set<PlanKey>& deposited) {
  // Including the blocks around, as the other end of a drop may lie there.
  std::set<PlanKey> seen;
  for (const PlanKey& block : deposited)
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) seen.insert({block.first + dy, block.second + dx});
  for (const PlanKey& key : seen) {
    auto& block = blocks_[key];
    const bool active = deposited.count(key) == 0;
    for (int c = 0; c < kBlockCells * kBlockCells; ++c) {
      const int ix = grid_.column_x(key, c), iy = grid_.column_y(key, c);
      // Particles on the ground count where it is active. Deposited blocks have none; the index is
      // older than the deposit and would count them twice.
      const double rest = (ground.height(ix, iy) - ground.datum()) / ground.cell();
      block[static_cast<std::size_t>(c)] =
          static_cast<float>(rest + (active ? index.pile_height(ix, iy) : 0.0));
    }
  }
}

bool StandingHeights::find(int ix, int iy, double& height) const {
  const auto found = blocks_.find(grid_.block_of(ix, iy));
  if (found == blocks_.end()) return false;
  height = static_cast<double>(found->second[static_cast<std::size_t>(grid_.place(ix, iy))]);
  return true;
}

void StandingHeights::visit(Archive& a) { a("blocks", blocks_); }

bool SlumpScan::stood_before(int ix, int iy, int lx, int ly, double drop) const {
  double high = 0, low = 0;
  const bool high_known = standing_.find(ix, iy, high), low_known = standing_.find(lx, ly, low);
  // On ground that may fall (no hold) both ends must be known; on ground that holds, the heights at
  // the start replace what was never moved.
  if (!hold_ && !(high_known && low_known)) return false;
  if (!high_known) high = (ground_.start_height(ix, iy) - ground_.datum()) / ground_.cell();
  if (!low_known) low = (ground_.start_height(lx, ly) - ground_.datum()) / ground_.cell();
  const bool active = top_[at(lx, ly)] > rest_[at(lx, ly)];
  return drop <= high - low + (active ? kGrownActive : kGrown);
}

void SlumpScan::read_window(int tx, int ty, const ColumnIndex& index) {
  // The margin is the reach of drops, so that each drop with one end in the tile is found.
  x0_ = tx * kTile - SlumpTable::kReach;
  y0_ = ty * kTile - SlumpTable::kReach;
  ground_.copy_heights({x0_, y0_, x0_ + kSide, y0_ + kSide}, rest_);
  // Heights of some thousand cells fit a float to better than a thousandth.
  for (float& h : rest_)
    h = static_cast<float>((static_cast<double>(h) - ground_.datum()) / ground_.cell());
  top_ = rest_;
  const PlanGrid& grid = index.grid();
  // Whole blocks are looked up, as most of a window holds no particles.
  const PlanKey first = grid.block_of(x0_, y0_),
                last = grid.block_of(x0_ + kSide - 1, y0_ + kSide - 1);
  for (int by = first.first; by <= last.first; ++by)
    for (int bx = first.second; bx <= last.second; ++bx) {
      if (index.find({by, bx}) < 0) continue;
      for (int c = 0; c < kBlockCells * kBlockCells; ++c) {
        const int ix = grid.column_x({by, bx}, c), iy = grid.column_y({by, bx}, c);
        if (ix < x0_ || ix >= x0_ + kSide || iy < y0_ || iy >= y0_ + kSide) continue;
        top_[at(ix, iy)] += static_cast<float>(index.pile_height(ix, iy));
      }
    }
}

bool SlumpScan::held_by_tool(const OverSteep& found, std::span<const ToolZone> zones,
                             double high) const {
  for (const ToolZone& tool : zones) {
    // A tool above the drop or below it holds nothing.
    if (tool.low >= high || tool.high <= found.low) continue;
    for (int l = 0; l <= found.steps; ++l)
      if (tool.touches(found.ix + l * found.dx, found.iy + l * found.dy)) return true;
  }
  return false;
}

// Finds out if the resting column (ix, iy) stands too high above the one `steps` away.
bool SlumpScan::look(int ix, int iy, int dx, int dy, int steps, std::span<const ToolZone> zones,
                     std::vector<OverSteep>& out) {
  const int lx = ix + dx * steps, ly = iy + dy * steps;
  const bool diagonal = dx != 0 && dy != 0;
  const double high = static_cast<double>(rest_[at(ix, iy)]),
               low = static_cast<double>(top_[at(lx, ly)]);
  // The cheapest test first: most pairs are far below the smallest drop.
  if (high - low <= limit_[diagonal][steps]) return false;
  if (!ground_.contains(ix, iy) || !ground_.contains(lx, ly)) return false;
  const double cell = ground_.cell();
  // Before the layers are read, which costs most.
  if (stood_before(ix, iy, lx, ly, high - low)) return false;
  ground_.column(ix, iy, layers_);
  if ((high - low) * cell <= table_.start(layers_, low * cell, high * cell, steps, diagonal))
    return false;
  const OverSteep found{ix, iy, dx, dy, steps, low};
  if (held_by_tool(found, zones, high)) return false;
  out.push_back(found);
  return true;
}

void SlumpScan::find_drops(int tile_x, int iy, int reach) {
  const float* rest = rest_.data() + at(tile_x, iy);
  const float* top = top_.data() + at(tile_x, iy);
  for (std::size_t d = 0; d < std::size(kDirections); ++d) {
    const int dx = kDirections[d][0], dy = kDirections[d][1];
    const bool diagonal = dx != 0 && dy != 0;
    // Local arrays, so that the compiler can compute several columns at a time.
    float down[kTile], up[kTile];
    std::fill(std::begin(down), std::end(down), -1e30F);
    std::fill(std::begin(up), std::end(up), -1e30F);
    for (int l = 1; l <= reach; ++l) {
      const auto limit = static_cast<float>(limit_[diagonal][l]);
      const std::ptrdiff_t away = static_cast<std::ptrdiff_t>(l) * (dy * kSide + dx);
      const float *low = top + away, *high = rest - away;
      for (int c = 0; c < kTile; ++c) {
        const float drop = rest[c] - low[c] - limit, rise = high[c] - top[c] - limit;
        down[c] = drop > down[c] ? drop : down[c];
        up[c] = rise > up[c] ? rise : up[c];
      }
    }
    std::copy(std::begin(down), std::end(down), down_[d].begin());
    std::copy(std::begin(up), std::end(up), up_[d].begin());
  }
}

void SlumpScan::scan(int tx, int ty, const ColumnIndex& index, std::span<const ToolZone> zones,
                     std::vector<OverSteep>& out) {
  read_window(tx, ty, index);
  // Largest drop that the window can hold; limits the distance to examine.
  const auto [least, unused] = std::minmax_element(top_.begin(), top_.end());
  const double range = static_cast<double>(*std::max_element(rest_.begin(), rest_.end()) - *least);
  int reach = 0;
  for (int l = 1; l <= SlumpTable::kReach; ++l)
    for (const bool diagonal : {false, true}) {
      limit_[diagonal][l] = table_.weakest(l, diagonal) / ground_.cell();
      if (range > limit_[diagonal][l]) reach = l;
    }
  if (reach == 0) return;

  const int tile_x = tx * kTile, tile_y = ty * kTile;
  const auto inside = [&](int ix, int iy) {
    return ix >= tile_x && ix < tile_x + kTile && iy >= tile_y && iy < tile_y + kTile;
  };
  for (int iy = tile_y; iy < tile_y + kTile; ++iy) {
    find_drops(tile_x, iy, reach);
    for (int ix = tile_x; ix < tile_x + kTile; ++ix)
      for (std::size_t d = 0; d < std::size(kDirections); ++d) {
        const int dx = kDirections[d][0], dy = kDirections[d][1];
        const auto c = static_cast<std::size_t>(ix - tile_x);
        // The nearest drop of a direction is enough: the columns in between slide with it.
        for (int l = 1; down_[d][c] > -kRounding && l <= reach; ++l)
          if (look(ix, iy, dx, dy, l, zones, out)) break;
        // From outside, with this column as the low one.
        for (int l = 1; up_[d][c] > -kRounding && l <= reach; ++l)
          if (!inside(ix - l * dx, iy - l * dy) &&
              look(ix - l * dx, iy - l * dy, dx, dy, l, zones, out))
            break;
      }
  }
}

}  // namespace navvy::soil
