// SPDX-License-Identifier: Apache-2.0
// How far a column may stand above another one: friction, and for cohesive soil the log spiral
// through its foot.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "heightfield/layered_ground.h"
#include "scene/soil.h"

namespace navvy::soil {

/// Tabulated once per soil, cohesion over unit weight, and distance; answers cost a lookup.
///
/// A drop over the distance d may reach the larger of d tan(phi + 2 deg), with a little room for
/// roughness, and the height at which a face that falls back by d - cell/2 fails on a log spiral
/// [Chen 1975].
class SlumpTable {
 public:
  /// Distances looked at, in columns along an axis or diagonal.
  static constexpr int kReach = 16;

  /// `cell` [m], `gravity` [m/s2].
  SlumpTable(const std::vector<scene::Soil>& soils, double cell, double gravity);

  /// Drop [m] at which soil remoulded by `shear` [-], lying at `specific_volume` (volume / bank
  /// volume), starts to slide over `steps` columns (1 .. kReach). Its cohesion over its unit weight
  /// is rounded down to one of sixteen levels: soil slides a little early, never late.
  double start(std::uint16_t soil, float shear, float specific_volume, int steps,
               bool diagonal) const;
  /// The least that the layers between two heights of a column allow. `layers` bottom first,
  /// heights in m above datum. Layers that the drop does not lay bare have no say; 100 m when none
  /// is.
  double start(std::span<const heightfield::SoilLayer> layers, double low, double high, int steps,
               bool diagonal) const;
  /// No soil slides below this drop [m]. The first question of every scan: it spares reading the
  /// layers of nearly all columns.
  double weakest(int steps, bool diagonal) const { return weakest_[place(0, 0, steps, diagonal)]; }
  /// Drop between neighbours [m] at which sliding soil stops. Lower than where sliding starts, so
  /// that what stopped does not start again at the next look.
  double stop(std::uint16_t soil) const { return stop_[soil]; }

 private:
  // All drops of a soil lie together: level, then distance, then straight or diagonal.
  static std::size_t place(std::size_t soil, int level, int steps, bool diagonal);

  // What a soil's cohesion is made of [Pa], as in the law, times 1 / cos phi.
  struct Strength {
    double loose, dense, bond, dense_offset, inv_range, inv_remould;
    /// Cohesion x specific volume of level 0, and from there to the highest level.
    double low, range;
  };
  static double cohesion(const Strength& of, double shear, double specific_volume);

  std::vector<scene::Soil> soils_;
  std::vector<Strength> strengths_;
  double cell_;
  std::vector<double> start_, weakest_, stop_;
};

}  // namespace navvy::soil
