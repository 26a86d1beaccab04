// SPDX-License-Identifier: Apache-2.0
#include "soil/exchange/slump_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/memo.h"
#include "soil/exchange/log_spiral.h"
#include "soil/particles/soil_table.h"

namespace navvy::soil {
namespace {

// Hysteresis about the friction angle [docs/exchange.md, slump].
constexpr double kStartAbove = radians(2.0), kStopBelow = radians(1.0);
/// Roughness of a heap deposited from particles, which does not make it steep [cells]. Tuned by
/// ExchangeDeposit.AHeapComesBackWithItsMassVolumeAndShape.
constexpr double kRoughness = 0.2;
/// Levels of cohesion times specific volume, from loose and remoulded to intact, the lower ones
/// closer together. Values are rounded down.
constexpr int kLevels = 16;
/// Largest height of a face [m].
constexpr double kHighest = 100;

/// What the drops of one soil follow from: friction angle [rad], cohesion x specific volume at the
/// lowest level and its difference to the highest level [Pa], unit weight in bank state [N/m3], and
/// edge of a cell [m].
using DropKey = std::array<double, 5>;

/// Returns the drops [m] of one soil at which it starts to slide, by level, distance and direction.
/// Takes a millisecond: 512 entries, each with a search.
std::vector<double> compute_drops(const DropKey& key) {
  const auto [friction_angle, low, range, weight, cell] = key;
  std::vector<double> out;
  const FaceHeights faces(friction_angle);
  for (int level = 0; level < kLevels; ++level) {
    const double share = static_cast<double>(level) / (kLevels - 1);
    const double strength = (low + range * share * share) / weight;
    for (int steps = 1; steps <= SlumpTable::kReach; ++steps)
      for (const bool diagonal : {false, true}) {
        const double distance = steps * cell * (diagonal ? std::sqrt(2.0) : 1.0);
        const double dry = distance * std::tan(friction_angle + kStartAbove) + kRoughness * cell;
        // The face falls back by half a cell less than the distance of the columns' centres
        // [docs/exchange.md, slump].
        out.push_back(std::max(dry, faces.height(strength, distance - 0.5 * cell, kHighest)));
      }
  }
  return out;
}

/// Returns the same, kept for the worlds of this process.
std::vector<double> drops_of(const DropKey& key) {
  // Never destroyed: a world may be made while static objects are destroyed.
  static auto& kept = *new Memo<DropKey, std::vector<double>>;
  return kept.at(key, [&] { return compute_drops(key); });
}

}  // namespace

// Soil by soil, then level, distance and direction; `weakest_` has the length of one level.
std::size_t SlumpTable::place(std::size_t soil, int level, int steps, bool diagonal) {
  return ((soil * kLevels + static_cast<std::size_t>(level)) * kReach +
          static_cast<std::size_t>(steps - 1)) *
             2 +
         (diagonal ? 1 : 0);
}

// As in the law [docs/soil.md, cohesion].
double SlumpTable::cohesion(const Strength& of, double shear, double specific_volume) {
  const double dense = std::clamp(of.dense_offset - specific_volume * of.inv_range, 0.0, 1.0);
  const double soft = 1 + std::max(0.0, shear) * of.inv_remould;
  return of.loose + of.dense * dense + of.bond / (soft * soft);
}

SlumpTable::SlumpTable(const std::vector<scene::Soil>& soils, double cell, double gravity)
    : soils_(soils), cell_(cell) {
  weakest_.assign(kReach * 2, kHighest);
  for (const scene::Soil& soil : soils) {
    // Soil of less than a degree of friction stops on level ground.
    stop_.push_back(cell * std::tan(std::max(soil.friction_angle - kStopBelow, 0.0)));
    const LawConstants law = law_constants(soil, cell);
    const double root = 1 / std::cos(soil.friction_angle);
    Strength of{law.k_loose * root,
                law.k_dense * root,
                law.k_bond * root,
                law.dense_offset,
                law.inv_range,
                law.inv_remould,
                0,
                0};
    of.low = std::min(of.loose * soil.swell, of.loose + of.dense);
    of.range = soil.cohesion - of.low;
    strengths_.push_back(of);
    // In the order of `place`.
    const std::vector<double> drops =
        drops_of({soil.friction_angle, of.low, of.range, soil.bank_density * gravity, cell});
    start_.insert(start_.end(), drops.begin(), drops.end());
    for (std::size_t i = 0; i < drops.size(); ++i) {
      double& least = weakest_[i % weakest_.size()];
      least = std::min(least, drops[i]);
    }
  }
}

double SlumpTable::start(std::uint16_t soil, float shear, float specific_volume, int steps,
                         bool diagonal) const {
  const Strength& of = strengths_[soil];
  // Loose soil weighs less. What counts is cohesion over unit weight, which is bank density x
  // gravity / specific volume. Cohesion grows towards the bank state, so only rounding goes below
  // the level of loose soil.
  const double volume = std::max(0.0, static_cast<double>(specific_volume));
  const double product = cohesion(of, static_cast<double>(shear), volume) * volume;
  const double share = of.range > 0 ? std::clamp((product - of.low) / of.range, 0.0, 1.0) : 0.0;
  const int level =
      std::min(static_cast<int>(std::sqrt(share) * (kLevels - 1) + 1e-9), kLevels - 1);
  return start_[place(soil, level, steps, diagonal)];
}

double SlumpTable::start(std::span<const heightfield::SoilLayer> layers, double low, double high,
                         int steps, bool diagonal) const {
  // From the datum up, as layers are stored.
  double least = kHighest, bottom = 0;
  for (const heightfield::SoilLayer& layer : layers) {
    const double top = bottom + kilograms(layer.mass) * static_cast<double>(layer.specific_volume) /
                                    (soils_[layer.soil].bank_density * cell_ * cell_);
    // Only layers that the drop exposes: soil below the low column is held from the sides.
    if (top > low && bottom < high)
      least = std::min(
          least, start(layer.soil, layer.plastic_shear, layer.specific_volume, steps, diagonal));
    bottom = top;
  }
  return least;
}

}  // namespace navvy::soil
