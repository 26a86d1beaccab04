// SPDX-License-Identifier: Apache-2.0
#include "soil/exchange/slump.h"

#include <algorithm>
#include <cmath>

#include "core/archive.h"
#include "scene/soil_values.h"

namespace navvy::soil {
namespace {

/// Sweeps per simulated second: a 1 m cliff needs about 90, and real soil about a second
/// [docs/exchange.md, slump].
constexpr double kSweepRate = 100;
/// Drops are levelled to within this height [m] [docs/exchange.md, slump].
constexpr double kEnough = 0.001;
/// Sweeps without motion after which a column is at rest again. Tuned by
/// ExchangeSlump.ACliffOfSandStopsNearItsFrictionAngle.
constexpr int kMostStill = 8;

}  // namespace

void Slump::fail(const OverSteep& found) {
  const double base = found.low * ground_.cell() + ground_.datum();
  // The low column itself is not among them: it only receives.
  for (int l = 0; l < found.steps; ++l) {
    const int ix = found.ix + l * found.dx, iy = found.iy + l * found.dy;
    // Columns in between that do not reach above it have nothing to shed.
    if (ground_.height(ix, iy) <= base + kEnough) continue;
    const auto [place, is_new] = sliding_.emplace(PlanKey{iy, ix}, Sliding{base, 0});
    // A column that slides already goes down to the lower of the two heights, and its count of
    // still sweeps restarts.
    if (!is_new && place->second.base > base) place->second = {base, 0};
  }
}

int Slump::due(double elapsed) {
  // Time without sliding is not made up for.
  if (idle()) debt_ = 0;
  debt_ += elapsed * kSweepRate;
  // The remainder is carried over, so that the number of sweeps follows simulated time and not the
  // length of a step.
  const double whole = std::floor(debt_);
  debt_ -= whole;
  return static_cast<int>(whole);
}

bool Slump::exchange(const PlanKey& a, const PlanKey& b) {
  const double ha = ground_.height(a.second, a.first), hb = ground_.height(b.second, b.first);
  const PlanKey& high = ha >= hb ? a : b;
  const PlanKey& low = ha >= hb ? b : a;
  const double top = std::max(ha, hb), drop = std::abs(ha - hb);
  // Only a column that failed, or that something fell on, sheds soil. Resting ground of the same
  // slope stands, as its drop was not too steep.
  const auto found = sliding_.find(high);
  if (found == sliding_.end()) return false;
  // The soil on top decides, as that is what moves.
  const double stop = table_.stop(ground_.surface_soil(high.second, high.first));
  if (drop <= stop + kEnough) return false;

  // Soil that loosens on the way raises the low column by more than it lowers the high one.
  const auto& soils = ground_.setup().soils;
  const auto loose = [&](const heightfield::SoilLayer& layer) {
    return std::max(layer.specific_volume, static_cast<float>(soils[layer.soil].swell));
  };
  ground_.column(high.second, high.first, taken_);
  if (taken_.empty()) return false;
  // Factor by which a layer thickens as it loosens. It is that of the uppermost layer; deeper ones
  // that move in the same sweep differ a little, which the next sweep evens out.
  const double ratio = static_cast<double>(loose(taken_.back())) /
                       static_cast<double>(taken_.back().specific_volume);
  // The two then differ by just the drop at which soil rests: the high one sinks by the depth, the
  // low one rises by it times the ratio. Never below the height that the column failed over.
  const double depth = std::min((drop - stop) / (1 + ratio), top - found->second.base);
  if (depth < 0.5 * kEnough) return false;

  taken_.clear();
  // In integers, so that no mass is lost to rounding of heights.
  ground_.take_above(high.second, high.first, top - depth, taken_);
  for (heightfield::SoilLayer& layer : taken_) {
    layer.specific_volume = loose(layer);
    layer.plastic_shear = std::max(layer.plastic_shear, scene::remoulded_shear(soils[layer.soil]));
    ground_.put(low.second, low.first, layer);
  }
  found->second.still = 0;
  // Only the soil that fell onto a resting column slides on.
  sliding_.emplace(low, Sliding{std::min(ha, hb), 0}).first->second.still = 0;
  return true;
}

void Slump::forget_still() {
  std::erase_if(sliding_, [](const auto& entry) { return entry.second.still >= kMostStill; });
}

void Slump::Sliding::visit(Archive& a) {
  a("base", base);
  a.ranged("still", still, 0, kMostStill);
}

void Slump::visit(Archive& a) {
  a.ranged("debt", debt_, 0, 1);
  a("sliding", sliding_);
  for (const auto& [key, sliding] : sliding_)
    a.require(ground_.contains(key.second, key.first), "sliding", "a column is outside the site");
}

}  // namespace navvy::soil
