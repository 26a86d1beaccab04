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

  /// Drop [m] at which soil remoulded by `shear` starts to slide over `steps` columns (1 .. kReach). Soil between
  /// intact and remoulded counts with the cohesion that is left, rounded down to one of eight levels: soil slides a
  /// little early, never late.
  double start(std::uint16_t soil, float shear, int steps, bool diagonal) const;
  /// The least that the layers between two heights of a column allow. `layers` bottom first, heights in m above datum.
  /// Layers that the drop does not lay bare have no say; 100 m when none is.
  double start(std::span<const heightfield::Layer> layers, double low, double high, int steps, bool diagonal) const;
  /// No soil slides below this drop [m]. The first question of every scan: it spares reading the layers of nearly all
  /// columns.
  double weakest(int steps, bool diagonal) const { return weakest_[place(0, 0, steps, diagonal)]; }
  /// Drop between neighbours [m] at which sliding soil stops. Lower than where sliding starts, so that what stopped
  /// does not start again at the next look.
  double stop(std::uint16_t soil) const { return stop_[soil]; }

  /// Culmann's critical height [m] of a face that falls back by `setback` [m]; 0 without cohesion. `friction_angle`
  /// [rad], `cohesion` [Pa], `unit_weight` [N/m3]; at most 100 m, which nobody asks beyond.
  static double critical_height(double cohesion, double friction_angle, double unit_weight, double setback);

 private:
  // All drops of a soil lie together: level, then distance, then straight or diagonal.
  static std::size_t place(std::size_t soil, int level, int steps, bool diagonal);

  std::vector<scene::Soil> soils_;
  double cell_;
  std::vector<double> start_, weakest_, stop_;
};

}  // namespace navvy::soil
