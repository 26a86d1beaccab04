// SPDX-License-Identifier: Apache-2.0
// The patch on which a tyre stands in soft ground: how long it is, how hard it presses, how deep it
// sinks.
#pragma once

#include "scene/machine.h"
#include "scene/soil.h"

namespace navvy::terramechanics {

/// Chord [m] that a circle of `radius` cuts off at `depth` below its lowest point [m]: l = 2 sqrt(2
/// r d), for d << r.
double chord_length(double radius, double depth);

/// One tyre's contact with soft ground; a twin pair has two alike, each with half the load.
struct TyrePatch {
  double radius = 0, width = 0;  ///< of the tyre [m]
  /// Static, of the tyre's spring: load of the pair / its stiffness [m].
  double deflection = 0;
  double sinkage = 0;      ///< of the soil under the tyre's lowest point [m]
  double pressure = 0;     ///< mean over the patch [Pa]
  double half_length = 0;  ///< from the middle to where the round tread leaves the ground [m]

  /// Depth [m] of the tread below the untouched surface at `ahead` [m] of the middle, either way:
  /// the tyre's circle flattened by its deflection, 0 where it has left the ground.
  double tread_depth(double ahead) const;
};

/// Patch under a wheel (or twin pair) that carries `load` [N] on `soil`.
///
/// Mean pressure p = load / (l b) on a length l = 2 sqrt(2 r (deflection + z / 2)), sinkage z by
/// the plate's law [Bekker 1969]: sinking lengthens the patch, which lowers the pressure, so the
/// two are solved together. A load that is not above zero has no patch: every length 0.
TyrePatch tyre_patch(const scene::Wheel& tyre, const scene::Soil& soil, double load);

}  // namespace navvy::terramechanics
