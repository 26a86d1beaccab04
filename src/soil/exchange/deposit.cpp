// SPDX-License-Identifier: Apache-2.0
#include "soil/exchange/deposit.h"

#include <algorithm>
#include <cmath>

namespace navvy::soil {
namespace {

// A block is at rest below this mass-weighted rms speed and this speed of the fastest particle
// [m/s], for this long [s] [docs/exchange.md, rest].
constexpr double kRestRms = 0.010, kRestMost = 0.060, kRestTime = 0.8;
/// Undercut walls and clods over a void would stand, and stay active, for ever. The wait for them
/// ends after this time [s].
constexpr double kHollowRest = 5;
/// A tool this far above the soil does not hinder its deposit [cells] [docs/exchange.md, deposit].
constexpr double kToolAbove = 2;
/// Volume of a block that is too small to judge [cells]: a quarter cell over all its columns.
constexpr double kLeastCapacity = 4;
/// Two columns that differ by this much form a cliff [cells]. Slopes of loose soil stay below 0.8
/// per column, and the number of particles over a column scatters by 0.65.
constexpr double kCliff = 1.5;
/// Number of the four neighbours that are at least level with a column of a wall.
constexpr int kInLine = 2;
/// Soil sheared less than this is ground that stands as it was cut; dug and dumped soil has 1 and
/// more [-]. A wall may carry spoil, so this share of a column is enough.
constexpr double kBonded = 0.5, kBondedShare = 0.25;
/// Unit of the columns' shares of a block's volume [cells].
constexpr double kShareUnit = 1.0 / (1 << 20);

double square_speed(const Particle& p) {
  double sum = 0;
  for (const float v : p.v) sum += static_cast<double>(v) * static_cast<double>(v);
  return sum;
}

bool at_rest(const ColumnIndex& index, int block) {
  double mass = 0, sum = 0, most = 0;
  for (const std::uint32_t i : index.block(block)) {
    // Squares are compared, so no root is computed per particle. Sums run in the index's order,
    // which does not depend on the input's.
    const double square = square_speed(index[i]);
    mass += index[i].mass;
    sum += index[i].mass * square;
    most = std::max(most, square);
  }
  // Written so that a NaN is not at rest.
  return sum < kRestRms * kRestRms * mass && most < kRestMost * kRestMost;
}

// Returns true if a tool keeps a block active: it is near, its zone would activate the block again,
// or it touches one of its particles.
bool tool_holds_off(const ColumnIndex& index, std::span<const ToolZone> zones, const PlanKey& key,
                    double top) {
  const int x0 = index.grid().column_x(key, 0), y0 = index.grid().column_y(key, 0);
  const auto meets = [&](const heightfield::CellRect& r) {
    return r.x0 < x0 + kBlockCells && r.x1 > x0 && r.y0 < y0 + kBlockCells && r.y1 > y0;
  };
  for (const ToolZone& tool : zones) {
    if (tool.supported || top + kToolAbove < tool.low) continue;
    // Soil that rule A would activate at once is not deposited.
    if (meets(tool.near) || (tool.engaged && meets(tool.zone) && top > tool.low - 1)) return true;
  }
  const auto stands = [&](int number) {
    return std::any_of(zones.begin(), zones.end(),
                       [&](const ToolZone& tool) { return tool.supported && tool.tool == number; });
  };
  const int b = index.find(key);
  for (const std::uint32_t i : index.block(b))
    // A particle on a side of a shell is near enough to touch it [docs/tools.md, sides].
    if (index[i].side != 0 && !stands((index[i].side - 1) / 2)) return true;
  return false;
}

}  // namespace

void update_rest(const ColumnIndex& index, double elapsed, RestTimes& rest) {
  // The new list holds only blocks that rest now, so that a block that was moved or left starts
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
  // The lowest possible surface is the datum, so 0 is below all of them.
  double top = 0;
  for (int c = 0; c < kBlockCells * kBlockCells; ++c) {
    const int ix = index.grid().column_x(key, c), iy = index.grid().column_y(key, c);
    const auto column = index.column(ix, iy);
    if (column.empty()) continue;
    // Soil beyond the edge has no column; the solver records it as left.
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

/// Returns the surface of a column with the soil on it [cells above datum].
double Depositor::surface(int ix, int iy) const {
  return (ground_.height(ix, iy) - ground_.datum()) / ground_.cell() + index_.pile_height(ix, iy);
}

/// Returns true if a good part of the soil over a column was hardly sheared.
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
    // Nothing is known beyond the site's edge: such neighbours count neither as drops nor as level.
    int drops = 0, level = 0;
    for (const auto& [dx, dy] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
      if (!ground_.contains(ix + dx, iy + dy)) continue;
      ++(std::abs(surface(ix + dx, iy + dy) - here) > kCliff ? drops : level);
    }
    out[static_cast<std::size_t>(c)] = drops > 0 && level >= kInLine && bonded(ix, iy);
  }
  return out;
}

// Returns integer shares of the block's columns that do not stand at a cliff. At least one is
// positive when there is soil over them.
std::array<std::int64_t, 16> Depositor::weights(const Plan& plan, int block) const {
  const PlanKey key = index_.blocks()[static_cast<std::size_t>(block)];
  std::array<std::int64_t, 16> out{};
  std::int64_t sum = 0;
  const PlanGrid& grid = index_.grid();
  for (std::size_t c = 0; c < 16; ++c) {
    const int place = static_cast<int>(c);
    if (plan.cliff[c] || !ground_.contains(grid.column_x(key, place), grid.column_y(key, place)))
      continue;
    // Integers, so that shares of mass add up exactly in any order.
    out[c] = std::llround((plan.shape.surface[c] - plan.shape.ground[c]) / kShareUnit);
    sum += out[c];
  }
  if (sum > 0) return out;
  // A few particles that the surface does not show stay in their columns.
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
    // Shapes of all blocks are computed from the ground before the first of them is deposited.
    const BlockShape shape = finder.find(key);
    if (shape.hollow && rest.at(key) < kHollowRest) continue;
    taken.push_back(block);
    plans.push_back({shape, cliffs(block)});
  }
  for (std::size_t i = 0; i < taken.size(); ++i) deposit_block(plans[i], taken[i]);
  return taken;
}

// Returns the volume of the soils' density states over the volume under the surface, without
// cliffs.
double Depositor::crowding(const std::vector<SoilShare>& shares, const Plan& plan) const {
  const double cell = ground_.cell();
  double state = 0, available = 0;
  // In cells: kMassQuantum converts quanta to kilograms, the bank density converts to volume, and
  // the cube of the cell to cells.
  for (const SoilShare& share : shares)
    state += kMassQuantum * share.volume /
             (ground_.setup().soils[share.soil].bank_density * cell * cell * cell);
  for (std::size_t c = 0; c < 16; ++c)
    if (!plan.cliff[c]) available += plan.shape.surface[c] - plan.shape.ground[c];
  // A few particles that the surface does not show are not crowded.
  return available > kLeastCapacity ? state / available : 1.0;
}

// At a cliff each column keeps the soil above it, in its own order of soils; nothing is shared.
void Depositor::deposit_column(int ix, int iy) {
  for (const SoilShare& share : soil_shares(index_, index_.column(ix, iy))) {
    heightfield::SoilLayer layer =
        layer_of(share, ground_.setup().soils[share.soil].swell, densest_);
    layer.mass = share.mass;
    ground_.put(ix, iy, layer);
  }
}

void Depositor::deposit_block(const Plan& plan, int block) {
  const PlanKey key = index_.blocks()[static_cast<std::size_t>(block)];
  const PlanGrid& grid = index_.grid();
  const std::array<std::int64_t, 16> weight = weights(plan, block);

  // Soil of the other columns is mixed in one pool; the iso-surface decides where it goes.
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
    share_out(ground_, layer_of(share, ground_.setup().soils[share.soil].swell, densest_, rise),
              share.mass, columns);
}

}  // namespace navvy::soil
