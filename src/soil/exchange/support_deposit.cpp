// SPDX-License-Identifier: Apache-2.0
#include "soil/exchange/support_deposit.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "heightfield/loose_soil.h"
#include "soil/exchange/spline.h"

namespace navvy::soil {
namespace {

/// Columns beside a tool's box belong to the tool, too: between two checks it moves by 0.3 of a
/// column.
constexpr int kBesideTool = 1;
/// Soil this far below a tool is not touched [cells], as in the rule that activates ahead of tools.
constexpr double kUnderTool = 1;
/// Unit of height in which shares of a support area's soil are counted [m].
constexpr double kShareUnit = 1e-7;

}  // namespace

bool tool_touches(std::span<const ToolZone> zones, int ix, int iy, double top) {
  return std::any_of(zones.begin(), zones.end(), [&](const ToolZone& tool) {
    const heightfield::CellRect& box = tool.box;
    const heightfield::CellRect beside{box.x0 - kBesideTool, box.y0 - kBesideTool,
                                       box.x1 + kBesideTool, box.y1 + kBesideTool};
    return !tool.supported && top > tool.low - kUnderTool && beside.contains(ix, iy);
  });
}

bool supports_machine(const heightfield::Ground& ground, const ColumnIndex& index,
                      std::span<const ToolZone> zones,
                      std::span<const SupportPlacement> support_areas, int ix, int iy) {
  for (const SupportPlacement& area : support_areas) {
    if (!area.rect().contains(ix, iy)) continue;
    const double top = ground.height(ix, iy) + index.pile_height(ix, iy) * ground.cell();
    if (area.meets(ix, iy, top))
      return !tool_touches(zones, ix, iy, (top - ground.datum()) / ground.cell());
  }
  return false;
}

// From the column's surface up, as in heightfield::LooseSoil.
const SupportDeposit::Stack& SupportDeposit::stack(int ix, int iy) {
  const auto [place, is_new] = stacks_.try_emplace(PlanKey{iy, ix});
  Stack& out = place->second;
  if (!is_new) return out;
  out.top = ground_.height(ix, iy);
  if (!ground_.contains(ix, iy)) return out;
  const double cell = ground_.cell(), gap = heightfield::kLooseGap * cell;
  for (const std::uint32_t i : index_.column(ix, iy)) {
    const Particle& p = index_[i];
    if (!(ground_.datum() + height_in_cells(p) * cell < out.top + gap)) continue;
    // Height of the particle's stress-free volume, spread over one column.
    const double density = ground_.setup().soils[p.soil].bank_density;
    out.grains.push_back(i);
    out.volumes.push_back(kilograms(p.mass) * static_cast<double>(p.j0) / (density * cell * cell));
    out.top += out.volumes.back();
    out.touched |= p.side != 0;
  }
  return out;
}

// By the position of each particle: counted by column, the height of a level layer would scatter by
// 6 cm.
double SupportDeposit::smoothed(int ix, int iy) {
  // One kernel smooths columns and particles.
  double height = 0;
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx)
      height += column_weight(dx) * column_weight(dy) * ground_.height(ix + dx, iy + dy);
  const PlanGrid& grid = index_.grid();
  for (int dy = -2; dy <= 2; ++dy)
    for (int dx = -2; dx <= 2; ++dx) {
      const Stack& near = stack(ix + dx, iy + dy);
      for (std::size_t g = 0; g < near.grains.size(); ++g) {
        const Particle& p = index_[near.grains[g]];
        const double x =
            static_cast<double>(kBlockCells) * p.block[0] + static_cast<double>(p.x[0]);
        const double y =
            static_cast<double>(kBlockCells) * p.block[1] + static_cast<double>(p.x[1]);
        height +=
            near.volumes[g] * spline(x - (ix - grid.x + 0.5)) * spline(y - (iy - grid.y + 0.5));
      }
    }
  return height;
}

SupportDeposit::PendingDeposit SupportDeposit::plan(const SupportPlacement& area,
                                                    std::set<PlanKey>& claimed) {
  PendingDeposit out;
  // Mass over each column, for soil too thin to show in heights.
  std::vector<std::int64_t> taken;
  bool shows = false;
  const heightfield::CellRect& rect = area.rect();
  for (int iy = rect.y0; iy < rect.y1; ++iy)
    for (int ix = rect.x0; ix < rect.x1; ++ix) {
      if (index_.column(ix, iy).empty()) continue;
      const Stack& soil = stack(ix, iy);
      if (soil.grains.empty() || soil.touched || !area.meets(ix, iy, soil.top)) continue;
      if (tool_touches(zones_, ix, iy, (soil.top - ground_.datum()) / ground_.cell())) continue;
      // Areas of a machine may overlap; a column's soil belongs to the first.
      if (!claimed.insert({iy, ix}).second) continue;
      // Soil that would reach into the wheel stays active.
      const double ground = ground_.height(ix, iy),
                   clearance = std::max(0.0, area.height_limit(ix, iy) - ground);
      double filled = 0;
      std::int64_t mass = 0;
      for (std::size_t g = 0; g < soil.grains.size() && filled + 0.5 * soil.volumes[g] <= clearance;
           ++g) {
        filled += soil.volumes[g];
        mass += index_[soil.grains[g]].mass;
        out.grains.push_back(soil.grains[g]);
      }
      if (mass == 0) continue;
      const double height = std::clamp(smoothed(ix, iy) - ground, 0.0, clearance);
      out.columns.push_back({ix, iy, std::llround(height / kShareUnit)});
      taken.push_back(mass);
      shows = shows || out.columns.back().weight > 0;
    }
  // All heights round to zero: shares follow masses instead.
  for (std::size_t c = 0; !shows && c < taken.size(); ++c) out.columns[c].weight = taken[c];
  return out;
}

int SupportDeposit::deposit(std::span<const SupportPlacement> support_areas,
                            std::vector<std::uint8_t>& removed, std::set<PlanKey>& blocks) {
  std::set<PlanKey> claimed;
  // All are planned before any is deposited, as the soil of one support area neighbours another.
  std::vector<PendingDeposit> pending_deposits;
  for (const SupportPlacement& area : support_areas)
    pending_deposits.push_back(plan(area, claimed));
  int count = 0;
  for (const PendingDeposit& pending_deposit : pending_deposits) {
    // Each soil is deposited on its own, as layers have one soil each.
    for (const SoilShare& share : soil_shares(index_, pending_deposit.grains))
      share_out(ground_, layer_of(share, ground_.setup().soils[share.soil].swell, densest_),
                share.mass, pending_deposit.columns);
    for (const std::uint32_t i : pending_deposit.grains) removed[i] = 1;
    for (const SharedColumn& column : pending_deposit.columns)
      blocks.insert(index_.grid().block_of(column.ix, column.iy));
    count += static_cast<int>(pending_deposit.columns.size());
  }
  return count;
}

}  // namespace navvy::soil
