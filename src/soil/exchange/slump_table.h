// SPDX-License-Identifier: Apache-2.0
// Largest height of a column above another one at which soil stands: by friction and, for cohesive
// soil, by the log spiral through the foot of the face.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "heightfield/layered_ground.h"
#include "scene/soil.h"

namespace navvy::soil {

/// Largest stable drops between two columns, tabulated by soil, cohesion / unit weight, and
/// distance. A query costs one look-up.
///
/// At a distance d the allowed drop is the larger of two values: d tan(phi + 2 deg) plus an
/// allowance for roughness, and the height at which a face that recedes by d - cell / 2 fails on a
/// log spiral [Chen 1975].
class SlumpTable {
 public:
  /// Longest tabulated distance, in columns along an axis or a diagonal.
  static constexpr int kReach = 16;

  /// Computes the table. `cell`: edge of a cell [m]; `gravity`: downward acceleration of gravity
  /// [m/s2].
  SlumpTable(const std::vector<scene::Soil>& soils, double cell, double gravity);

  /// Returns the drop [m] above which soil starts to slide. `soil`: index of the soil; `shear`: its
  /// plastic shear [-]; `specific_volume`: its volume / bank volume; `steps`: distance in columns,
  /// 1 .. kReach; `diagonal`: true for a distance along a diagonal.
  ///
  /// Cohesion / unit weight is rounded down to one of sixteen levels, so soil slides slightly early
  /// but never late.
  double start(std::uint16_t soil, float shear, float specific_volume, int steps,
               bool diagonal) const;
  /// Returns the drop [m] above which the first of a column's exposed layers starts to slide.
  /// `layers`: the column's layers from bottom to top; `low`, `high`: heights between which layers
  /// are exposed [m above datum]; `steps` and `diagonal` as above. Returns 100 m if no layer is
  /// exposed.
  double start(std::span<const heightfield::SoilLayer> layers, double low, double high, int steps,
               bool diagonal) const;
  /// Returns the drop [m] below which no soil slides over this distance. A scan tests it first,
  /// which avoids reading the layers of almost all columns.
  double weakest(int steps, bool diagonal) const { return weakest_[place(0, 0, steps, diagonal)]; }
  /// Returns the drop between neighbouring columns at which sliding soil stops [m]. It is smaller
  /// than the drop at which sliding starts, so that soil that has stopped does not start again at
  /// once.
  double stop(std::uint16_t soil) const { return stop_[soil]; }

 private:
  /// Returns the index of an entry in start_. Entries of a soil are contiguous, ordered by cohesion
  /// level, then distance, then straight or diagonal.
  static std::size_t place(std::size_t soil, int level, int steps, bool diagonal);

  /// Terms of the cohesion of one soil [Pa] and their dependence on density state and plastic
  /// shear. The terms are those of the soil law (law_constants.h) divided by cos(phi).
  struct Strength {
    /// `loose`, `dense`, `bond`: cohesion of loose soil, its increase towards bank density, and
    /// that of intact bonds [Pa]; the others are the law's constants of the same names.
    double loose, dense, bond, dense_offset, inv_range, inv_remould;
    /// Cohesion x specific volume at the lowest level, and its difference to the highest level
    /// [Pa].
    double low, range;
  };
  /// Returns the cohesion of a soil at a given plastic shear and volume ratio [Pa].
  static double cohesion(const Strength& of, double shear, double specific_volume);

  /// Soils of the world.
  std::vector<scene::Soil> soils_;
  /// Cohesion terms, by soil index.
  std::vector<Strength> strengths_;
  /// Edge of a cell [m].
  double cell_;
  /// Drops [m]: start_ at which soil starts to slide (indexed by `place`), weakest_ the smallest of
  /// them over all soils by distance, stop_ at which sliding stops by soil.
  std::vector<double> start_, weakest_, stop_;
};

}  // namespace navvy::soil
