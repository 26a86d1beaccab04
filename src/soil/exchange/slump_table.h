// SPDX-License-Identifier: Apache-2.0
// Largest height of a column above another one: by friction, and for cohesive soil by the log
// spiral through its foot.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "heightfield/layered_ground.h"
#include "scene/soil.h"

namespace navvy::soil {

/// Allowed drops, tabulated once per soil, cohesion over unit weight, and distance. A query costs
/// one lookup.
///
/// A drop over the distance d may reach the larger of d tan(phi + 2 deg), with an allowance for
/// roughness, and the height at which a face that falls back by d - cell/2 fails on a log spiral
/// [Chen 1975].
class SlumpTable {
 public:
  /// Longest distance, in columns along an axis or a diagonal.
  static constexpr int kReach = 16;

  /// Builds the table. `cell` [m], `gravity` [m/s2].
  SlumpTable(const std::vector<scene::Soil>& soils, double cell, double gravity);

  /// Returns the drop [m] at which soil of plastic shear `shear` [-] and volume ratio
  /// `specific_volume` starts to slide over `steps` columns (1 .. kReach). Its cohesion over unit
  /// weight is rounded down to one of sixteen levels: soil slides a little early, never late.
  double start(std::uint16_t soil, float shear, float specific_volume, int steps,
               bool diagonal) const;
  /// Returns the smallest drop [m] that the layers between two heights of a column allow. `layers`
  /// bottom first, heights in m above datum. Layers that the drop does not expose do not count; 100
  /// m when there is none.
  double start(std::span<const heightfield::SoilLayer> layers, double low, double high, int steps,
               bool diagonal) const;
  /// Returns the drop [m] below which no soil slides. Every scan asks for it first, which avoids
  /// reading the layers of nearly all columns.
  double weakest(int steps, bool diagonal) const { return weakest_[place(0, 0, steps, diagonal)]; }
  /// Returns the drop between neighbours [m] at which sliding soil stops. It is lower than the drop
  /// that starts sliding, so that what stopped does not start again at once.
  double stop(std::uint16_t soil) const { return stop_[soil]; }

 private:
  // Returns the index of a drop. Those of a soil are contiguous: level, then distance, then
  // straight or diagonal.
  static std::size_t place(std::size_t soil, int level, int steps, bool diagonal);

  // Cohesion of a soil by its parts [Pa], as in the law, times 1 / cos phi.
  struct Strength {
    double loose, dense, bond, dense_offset, inv_range, inv_remould;
    /// Cohesion x specific volume of level 0, and the difference to the highest level.
    double low, range;
  };
  /// Returns the cohesion after plastic shear at a volume ratio [Pa].
  static double cohesion(const Strength& of, double shear, double specific_volume);

  std::vector<scene::Soil> soils_;
  std::vector<Strength> strengths_;
  double cell_;
  std::vector<double> start_, weakest_, stop_;
};

}  // namespace navvy::soil
