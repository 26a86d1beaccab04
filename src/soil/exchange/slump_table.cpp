// SPDX-License-Identifier: Apache-2.0
#include "soil/exchange/slump_table.h"

#include <algorithm>
#include <cmath>

namespace navvy::soil {
namespace {

// Hysteresis about the friction angle [docs/exchange.md, slump].
constexpr double kStartAbove = radians(2.0), kStopBelow = radians(1.0);
/// A heap booked back from particles is this rough without being steep [cells].
/// tuned: ExchangeDeposit.AHeapComesBackWithItsMassVolumeAndShape.
constexpr double kRoughness = 0.2;
/// Cohesion between intact and remoulded is tabulated in this many levels, rounded down.
constexpr int kLevels = 8;
/// Higher faces than this are not asked for [m].
constexpr double kHighest = 100;

}  // namespace

std::size_t SlumpTable::place(std::size_t soil, int level, int steps, bool diagonal) {
  return ((soil * kLevels + static_cast<std::size_t>(level)) * kReach + static_cast<std::size_t>(steps - 1)) * 2 +
         (diagonal ? 1 : 0);
}

double SlumpTable::critical_height(double cohesion, double friction_angle, double unit_weight, double setback) {
  if (cohesion <= 0) return 0;
  const auto stands = [&](double h) {
    const double face = std::atan2(h, setback);
    if (face <= friction_angle) return true;
    return h * unit_weight * (1 - std::cos(face - friction_angle)) <=
           4 * cohesion * std::sin(face) * std::cos(friction_angle);
  };
  // The allowed height falls as the face steepens, so there is one crossing.
  double low = 0, high = kHighest;
  if (stands(high)) return high;
  for (int i = 0; i < 60; ++i) (stands(0.5 * (low + high)) ? low : high) = 0.5 * (low + high);
  return low;
}

SlumpTable::SlumpTable(const std::vector<scene::Soil>& soils, double cell, double gravity)
    : soils_(soils), cell_(cell) {
  start_.resize(soils.size() * kLevels * kReach * 2);
  weakest_.assign(kReach * 2, kHighest);
  for (std::size_t s = 0; s < soils.size(); ++s) {
    const scene::Soil& soil = soils[s];
    stop_.push_back(cell * std::tan(std::max(soil.friction_angle - kStopBelow, 0.0)));
    for (int level = 0; level < kLevels; ++level)
      for (int steps = 1; steps <= kReach; ++steps)
        for (const bool diagonal : {false, true}) {
          const double distance = steps * cell * (diagonal ? std::sqrt(2.0) : 1.0);
          const double cohesion =
              soil.residual_cohesion + (soil.cohesion - soil.residual_cohesion) * level / (kLevels - 1);
          const double dry = distance * std::tan(soil.friction_angle + kStartAbove) + kRoughness * cell;
          const double cohesive =
              critical_height(cohesion, soil.friction_angle, soil.bank_density * gravity, distance - 0.5 * cell);
          const double drop = std::max(dry, cohesive);
          start_[place(s, level, steps, diagonal)] = drop;
          double& least = weakest_[place(0, 0, steps, diagonal)];
          least = std::min(least, drop);
        }
  }
}

double SlumpTable::start(std::uint16_t soil, float shear, int steps, bool diagonal) const {
  // Share of the bond that is left, as in the law [docs/soil.md, cohesion].
  const double soft = 1 + std::max(0.0, static_cast<double>(shear)) / soils_[soil].remoulding_strain;
  const int level = static_cast<int>(std::clamp(std::floor((kLevels - 1) / (soft * soft)), 0.0, kLevels - 1.0));
  return start_[place(soil, level, steps, diagonal)];
}

double SlumpTable::start(std::span<const heightfield::Layer> layers, double low, double high, int steps,
                         bool diagonal) const {
  double least = kHighest, bottom = 0;
  for (const heightfield::Layer& layer : layers) {
    const double top = bottom + kilograms(layer.mass) * static_cast<double>(layer.specific_volume) /
                                    (soils_[layer.soil].bank_density * cell_ * cell_);
    if (top > low && bottom < high) least = std::min(least, start(layer.soil, layer.plastic_shear, steps, diagonal));
    bottom = top;
  }
  return least;
}

}  // namespace navvy::soil
