// SPDX-License-Identifier: Apache-2.0
// Load history of a column under wheels and tracks.
#pragma once

#include <limits>

#include "core/archive.h"
#include "scene/soil.h"

namespace navvy::coupling {

/// Records the largest pressure on a column and the surface height at that time. A load
/// that stands still, or passes again, adds nothing; a heavier one presses further.
///
/// Soil that was added since is fresh and is compacted from its own surface on, but the ground
/// below keeps its history: a rut whose walls slide in is pressed to its old floor and not as deep
/// again. The history is cleared where ground was removed below that floor.
struct RutMemory {
  /// Largest pressure on the surface [Pa].
  double pressure = 0;
  /// Height of that surface [m].
  double height = 0;
  /// Largest pressure on the ground below fresh soil, 0 if there is none [Pa].
  double floor_pressure = 0;
  /// Height of the ground below fresh soil [m].
  double floor_height = 0;

  /// Compares the record with the present height `surface` [m] of the column.
  void find(double surface);

  /// Result of `press`: the plate's sinkage before, and how far the column is pressed down [m].
  struct Press {
    double before = 0, drop = 0;
  };
  /// Presses the column by at most `at_most` [m] under a plate of `width` [m] with the pressure
  /// `applied` [Pa]. Records the load; the caller stores the new surface in `height`.
  Press press(const scene::Soil& soil, double width, double surface, double applied,
              double at_most = std::numeric_limits<double>::infinity());

  /// Visits pressures and heights.
  void visit(Archive& a);
};

}  // namespace navvy::coupling
