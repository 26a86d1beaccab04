// SPDX-License-Identifier: Apache-2.0
#include "soil/exchange/deposit.h"

#include <algorithm>
#include <cmath>

namespace navvy::soil {
namespace {

// At rest: mass-weighted rms and fastest particle [m/s], for so long [s] [docs/exchange.md, rest].
constexpr double kRestRms = 0.010, kRestMost = 0.060, kRestTime = 0.8;
/// Undercut walls and clods over a void stand for good; without an end to the wait they stay awake
/// for good too [s].
constexpr double kHollowRest = 5;
/// A tool this far above the soil leaves it free to settle [cells] [docs/exchange.md, deposit].
constexpr double kToolAbove = 2;
/// Volume of a block too thin to tell [cells]: a quarter cell over all its columns.
constexpr double kLeastCapacity = 4;
/// Two columns that differ by this much stand at a cliff [cells]: slopes of loose soil stay below
/// 0.8 a column, and the number of particles over a column scatters by 0.65.
constexpr double kCliff = 1.5;
/// Of the four neighbours so many at least are level with a column that belongs to a wall.
constexpr int kInLine = 2;
/// Soil sheared less than this is ground that stands as it was cut; dug and dumped soil has 1 and
/// more [-]. A wall may carry spoil: this share of a column is enough.
constexpr double kBonded = 0.5, kBondedShare = 0.25;
/// Columns' shares of a block's volume are counted in this fraction of a cell.
constexpr double kShareUnit = 1.0 / (1 << 20);

double square_speed(const Particle& p) {
  double sum = 0;
  for (const float v : p.v) sum += static_cast<double>(v) * static_cast<double>(v);
  return sum;
}

bool at_rest(const ColumnIndex& index, int block) {
  double mass = 0, sum = 0, most = 0;
  for (const std::uint32_t i : index.block(block)) {
    // Squares are compared, so no root is taken for a particle; sums run in the index's order,
    // which does not depend on the input's.
    const double square = square_speed(index[i]);
    mass += index[i].mass;
    sum += index[i].mass * square;
    most = std::max(most, square);
  }
  // Written so that a NaN is not at rest.
  return sum < kRestRms * kRestRms * mass && most < kRestMost * kRestMost;
}

// A tool keeps a block awake when it is near, when its zone would wake the block again, or when it
// touches a particle of it.
bool tool_holds_off(const ColumnIndex& index, std::span<const ToolZone> zones, const PlanKey& key,
                    double top) {
  const int x0 = index.grid().column_x(key, 0), y0 = index.grid().column_y(key, 0);
  const auto meets = [&](const heightfield::CellRect& r) {
    return r.x0 < x0 + kBlockCells && r.x1 > x0 && r.y0 < y0 + kBlockCells && r.y1 > y0;
  };
  for (const ToolZone& tool : zones) {
    if (tool.supported || top + kToolAbove < tool.low) continue;
    // What rule A would wake again at once is not booked back either.
    if (meets(tool.near) || (tool.engaged && meets(tool.zone) && top > tool.low - 1)) return true;
  }
  const auto stands = [&](int number) {
    return std::any_of(zones.begin(), zones.end(),
                       [&](const ToolZone& tool) { return tool.supported && tool.tool == number; });
  };
  const int b = index.find(key);
  for (const std::uint32_t i : index.block(b))
    // A particle that is on a side of a shell is near enough to touch it [docs/tools.md, sides].
    if (index[i].side != 0 && !stands((index[i].side - 1) / 2)) return true;
  return false;
}

}  // namespace

void update_rest(const ColumnIndex& index, double elapsed, RestTimes& rest) {
  // The new list holds only blocks that rest now, so that one that was moved or has left starts
  // from zero.
  RestTimes now;
  for (std::size_t b = 0; b < index.blocks().size(); ++b) {
    if (!at_rest(index, static_cast<int>(b))) continue;
    const auto found = rest.find(index.blocks()[b]);
    // The first check at which a block rests counts as no time: it may have stopped just now.
    now.emplace(index.blocks()[b], found == rest.end() ? 0.0 : found->second + elapsed);
  }
  rest.swap(now);
}

bool may_deposit(const heightfield::Ground& ground, const ColumnIndex& index,
                 std::span<const ToolZone> zones, const RestTimes& rest, int block) {
  const PlanKey key = index.blocks()[static_cast<std::size_t>(block)];
  const auto found = rest.find(key);
  if (found == rest.end() || found->second < kRestTime) return false;
  const int x0 = index.grid().column_x(key, 0), y0 = index.grid().column_y(key, 0);
  // Lowest surface a block can have is the datum, so 0 is below all of them.
  double top = 0;
  for (int c = 0; c < kBlockCells * kBlockCells; ++c) {
    const int ix = index.grid().column_x(key, c), iy = index.grid().column_y(key, c);
    const auto column = index.column(ix, iy);
    if (column.empty()) continue;
    // Soil beyond the edge has no column to go to; the solver books it as left.
    if (!ground.contains(ix, iy)) return false;
    top = std::max(top, height_in_cells(index[column.back()]));
  }
  if (tool_holds_off(index, zones, key, top)) return false;
  // Nothing may move in the columns around it either.
  for (int iy = y0 - 1; iy <= y0 + kBlockCells; ++iy)
    for (int ix = x0 - 1; ix <= x0 + kBlockCells; ++ix)
      for (const std::uint32_t i : index.column(ix, iy))
        if (!(square_speed(index[i]) < kRestMost * kRestMost)) return false;
  return true;
}

/// Where a column's surface is with what lies on it [cells above datum].
double Depositor::surface(int ix, int iy) const {
  return (ground_.height(ix, iy) - ground_.datum()) / ground_.cell() + index_.pile_height(ix, iy);
}

/// Whether a good part of the soil over a column was hardly sheared.
bool Depositor::bonded(int ix, int iy) const {
  std::int64_t mass = 0, firm = 0;
  for (const std::uint32_t i : index_.column(ix, iy)) {
    mass += index_[i].mass;
    if (static_cast<double>(index_[i].shear) < kBonded) firm += index_[i].mass;
  }
  return static_cast<double>(firm) >= kBondedShare * static_cast<double>(mass);
}

std::array<bool, 16> Depositor::cliffs(int block) const {
  const PlanKey key = index_.blocks()[static_cast<std::size_t>(block)];
  std::array<bool, 16> out{};
  for (int c = 0; c < 16; ++c) {
    const int ix = index_.grid().column_x(key, c), iy = index_.grid().column_y(key, c);
    if (!ground_.contains(ix, iy)) continue;
    const double here = surface(ix, iy);
    // Beyond the site's edge nothing is known, so such neighbours count neither as drops nor as
    // level.
    int drops = 0, level = 0;
    for (const auto& [dx, dy] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
      if (!ground_.contains(ix + dx, iy + dy)) continue;
      ++(std::abs(surface(ix + dx, iy + dy) - here) > kCliff ? drops : level);
    }
    out[static_cast<std::size_t>(c)] = drops > 0 && level >= kInLine && bonded(ix, iy);
  }
  return out;
}

// Integer shares of the block's columns that stand at no cliff; at least one is positive when soil
// lies over them.
std::array<std::int64_t, 16> Depositor::weights(const Plan& plan, int block) const {
  const PlanKey key = index_.blocks()[static_cast<std::size_t>(block)];
  std::array<std::int64_t, 16> out{};
  std::int64_t sum = 0;
  const PlanGrid& grid = index_.grid();
  for (std::size_t c = 0; c < 16; ++c) {
    const int place = static_cast<int>(c);
    if (plan.cliff[c] || !ground_.contains(grid.column_x(key, place), grid.column_y(key, place)))
      continue;
    // Whole numbers, so that shares of mass add up exactly whatever their order.
    out[c] = std::llround((plan.shape.surface[c] - plan.shape.ground[c]) / kShareUnit);
    sum += out[c];
  }
  if (sum > 0) return out;
  // A few grains that do not show in the surface stay in their columns.
  for (std::size_t c = 0; c < 16; ++c) {
    if (plan.cliff[c]) continue;
    const int place = static_cast<int>(c);
    for (const std::uint32_t i :
         index_.column(grid.column_x(key, place), grid.column_y(key, place)))
      out[c] += index_[i].mass;
  }
  return out;
}

std::vector<int> Depositor::deposit(std::span<const int> blocks, const RestTimes& rest) {
  ShapeFinder finder(ground_, index_);
  std::vector<int> taken;
  std::vector<Plan> plans;
  for (const int block : blocks) {
    const PlanKey& key = index_.blocks()[static_cast<std::size_t>(block)];
    // Shapes of all blocks are read from the ground as it is before the first of them is booked.
    const BlockShape shape = finder.find(key);
    if (shape.hollow && rest.at(key) < kHollowRest) continue;
    taken.push_back(block);
    plans.push_back({shape, cliffs(block)});
  }
  for (std::size_t i = 0; i < taken.size(); ++i) book(plans[i], taken[i]);
  return taken;
}

// Volume of the soils' density states over that under the surface, cliffs left out.
double Depositor::crowding(const std::vector<SoilShare>& shares, const Plan& plan) const {
  const double cell = ground_.cell();
  double state = 0, room = 0;
  // In cells: kMassQuantum turns quanta into kilograms, the bank density into volume, and the
  // cell's cube into cells.
  for (const SoilShare& share : shares)
    state += kMassQuantum * share.volume /
             (ground_.setup().soils[share.soil].bank_density * cell * cell * cell);
  for (std::size_t c = 0; c < 16; ++c)
    if (!plan.cliff[c]) room += plan.shape.surface[c] - plan.shape.ground[c];
  // A few crumbs that the surface does not show are not crowded.
  return room > kLeastCapacity ? state / room : 1.0;
}

// At a cliff each column keeps what lay over it, and in its own order of soils; nothing is shared
// out.
void Depositor::deposit_column(int ix, int iy) {
  for (const SoilShare& share : soil_shares(index_, index_.column(ix, iy))) {
    heightfield::SoilLayer layer = layer_of(share, ground_.setup().soils[share.soil].swell);
    layer.mass = share.mass;
    ground_.put(ix, iy, layer);
  }
}

void Depositor::book(const Plan& plan, int block) {
  const PlanKey key = index_.blocks()[static_cast<std::size_t>(block)];
  const PlanGrid& grid = index_.grid();
  const std::array<std::int64_t, 16> weight = weights(plan, block);

  // Soil of columns at no cliff is mixed in one pool, as the iso-surface says where it goes.
  std::vector<std::uint32_t> pooled;
  std::vector<SharedColumn> columns;
  for (std::size_t c = 0; c < 16; ++c) {
    const int ix = grid.column_x(key, static_cast<int>(c)),
              iy = grid.column_y(key, static_cast<int>(c));
    columns.push_back({ix, iy, weight[c]});
    const Grains grains = index_.column(ix, iy);
    if (plan.cliff[c])
      deposit_column(ix, iy);
    else
      pooled.insert(pooled.end(), grains.begin(), grains.end());
  }
  const std::vector<SoilShare> found = soil_shares(index_, pooled);
  const double rise = crowding(found, plan);
  for (const SoilShare& share : found)
    share_out(ground_, layer_of(share, ground_.setup().soils[share.soil].swell, rise), share.mass,
              columns);
}

}  // namespace navvy::soil
