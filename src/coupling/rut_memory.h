// SPDX-License-Identifier: Apache-2.0
// Load history of a ground column under wheels and tracks.
#pragma once

#include <limits>

#include "core/archive.h"
#include "scene/soil.h"

namespace navvy::coupling {

/// The depth to which loads have pressed a column, as the pressure of one load that presses so
/// deep, and the height of its surface after that. A load that stands still does not press the
/// column any further; only a greater pressure does, or another pass.
///
/// Passes add up by the exponent a of the soil (scene::Soil::multi_pass_exponent): with the depth
/// z0 at its arrival, a load that alone would sink by z1 ends at z, z^a = z0^a + z1^a. Equal passes
/// thus reach z1, 2^(1/a) z1, 3^(1/a) z1 and so on. With a = 0 it ends at the larger of both
/// depths.
///
/// Fresh soil that has been added since is compacted from its own surface, but the ground below it
/// keeps its history. When the walls of a rut slide in, a wheel therefore presses down to the old
/// floor of the rut, not twice as deep. The history is cleared if ground is removed below that
/// floor.
struct RutMemory {
  /// Pressure that presses the soil at the surface as deep as it is pressed now [Pa]: with single
  /// passes, the maximum pressure so far.
  double pressure = 0;
  /// Value of `pressure` when the present load arrived [Pa]; 0 where repeated passes add nothing.
  double arrived = 0;
  /// Height of the surface in W after it was pressed last [m].
  double height = 0;
  /// Maximum pressure on the ground below fresh soil [Pa]; 0 if there is no fresh soil.
  double floor_pressure = 0;
  /// Value of `floor_pressure` when the present load arrived [Pa], as `arrived`.
  double floor_arrived = 0;
  /// Height in W of the ground below fresh soil [m].
  double floor_height = 0;

  /// Detects from the current height `surface` of the column in W [m] whether soil has been added
  /// or removed since the last press, and updates the history. Call it before `press`.
  void find(double surface);

  /// Begins another pass on `soil`. Call it when a load arrives on the column, after `find`.
  void arrive(const scene::Soil& soil) {
    const bool repeats = soil.multi_pass_exponent > 0;
    arrived = repeats ? pressure : 0;
    floor_arrived = repeats ? floor_pressure : 0;
  }
  /// Ends the pass of the last tyre: whatever presses next, until another load arrives, sinks to
  /// the larger of both depths and adds nothing. Call it for loads that do not add up, after
  /// `find`.
  void leave() { arrived = floor_arrived = 0; }

  /// Result of `press`.
  struct Press {
    /// `before` is the sinkage of the plate before [m], and `drop` the distance by which the caller
    /// must lower the column [m].
    double before = 0, drop = 0;
    /// Work of that drop per unit of area [J/m2]: the pressure of the load, which grows from zero
    /// in each pass, times the distance that it sinks.
    double work = 0;
  };
  /// Computes the effect of a plate that presses on the column, and updates the pressures in the
  /// history. The caller must lower the column by the returned distance and then store the new
  /// height in `height`.
  ///
  /// `soil` is the soil at the surface, `width` the width of the plate [m], `surface` the current
  /// height of the column in W [m], `applied` the pressure [Pa], and `at_most` the maximum distance
  /// by which the column is lowered [m].
  Press press(const scene::Soil& soil, double width, double surface, double applied,
              double at_most = std::numeric_limits<double>::infinity());

  /// Saves or loads pressures and heights.
  void visit(Archive& a);
};

}  // namespace navvy::coupling
