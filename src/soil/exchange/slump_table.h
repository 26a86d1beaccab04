// SPDX-License-Identifier: Apache-2.0
// How far a column may stand above another one: friction, and for cohesive soil the plane wedge of Culmann.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "heightfield/ground.h"
#include "scene/soil.h"

namespace navvy::soil {

/// Tabulated once per soil, cohesion and distance; answers cost a lookup.
///
/// A drop over the distance d may reach the larger of d tan(phi + 2 deg), with a little room for roughness, and
/// Culmann's height for a face that falls back by d - cell/2: the largest H with
/// H <= 4 c sin b cos phi / (gamma (1 - cos(b - phi))), b = atan(H / w) [Taylor 1948].
class SlumpTable {
 public:
  /// Distances looked at, in columns along an axis or diagonal.
  static constexpr int kReach = 16;

  /// `cell` [m], `gravity` [m/s2].
  SlumpTable(const std::vector<scene::Soil>& soils, double cell, double gravity);

  /// Drop [m] at which soil remoulded by `shear` starts to slide over `steps` columns (1 .. kReach).
  double start(std::uint16_t soil, float shear, int steps, bool diagonal) const;
  /// The least that the layers between two heights of a column allow. `layers` bottom first, heights in m above datum.
  double start(std::span<const heightfield::Layer> layers, double low, double high, int steps, bool diagonal) const;
  /// No soil slides below this drop [m].
  double weakest(int steps, bool diagonal) const { return weakest_[place(0, 0, steps, diagonal)]; }
  /// Drop between neighbours [m] at which sliding soil stops.
  double stop(std::uint16_t soil) const { return stop_[soil]; }

  /// Culmann's critical height [m] of a face that falls back by `setback` [m]; 0 without cohesion.
  static double critical_height(double cohesion, double friction_angle, double unit_weight, double setback);

 private:
  static std::size_t place(std::size_t soil, int level, int steps, bool diagonal);

  std::vector<scene::Soil> soils_;
  double cell_;
  std::vector<double> start_, weakest_, stop_;
};

}  // namespace navvy::soil
