// SPDX-License-Identifier: Apache-2.0
// Load history of a ground column under wheels and tracks.
#pragma once

#include <limits>

#include "core/archive.h"
#include "scene/soil.h"

namespace navvy::coupling {

/// The maximum pressure that a column has carried, and the height of its surface after that. A load
/// that stands still or passes again does not press the column any further; only a greater pressure
/// does.
///
/// Fresh soil that has been added since is compacted from its own surface, but the ground below it
/// keeps its history. When the walls of a rut slide in, a wheel therefore presses down to the old
/// floor of the rut, not twice as deep. The history is cleared if ground is removed below that
/// floor.
struct RutMemory {
  /// Maximum pressure on the soil at the surface so far [Pa].
  double pressure = 0;
  /// Height of the surface in W after it was pressed last [m].
  double height = 0;
  /// Maximum pressure on the ground below fresh soil [Pa]; 0 if there is no fresh soil.
  double floor_pressure = 0;
  /// Height in W of the ground below fresh soil [m].
  double floor_height = 0;

  /// Detects from the current height `surface` of the column in W [m] whether soil has been added
  /// or removed since the last press, and updates the history. Call it before `press`.
  void find(double surface);

  /// Result of `press`.
  struct Press {
    /// `before` is the sinkage of the plate under the previous maximum pressure [m], and `drop` the
    /// distance by which the caller must lower the column [m].
    double before = 0, drop = 0;
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
