// SPDX-License-Identifier: Apache-2.0
// Contact patch of a tyre in soft ground: its length, pressure and sinkage.
#pragma once

#include "scene/machine.h"
#include "scene/soil.h"

namespace navvy::terramechanics {

/// Returns the chord [m] of a circle of `radius` at `depth` above its lowest point [m]: l = 2
/// sqrt(2 r d), for d << r.
double chord_length(double radius, double depth);

/// Contact of one tyre with soft ground. A twin pair has two alike, each with half the load.
struct TyrePatch {
  /// Radius and width of the tyre [m].
  double radius = 0, width = 0;
  /// Static deflection of the tyre: load of the pair / its stiffness [m].
  double deflection = 0;
  /// Sinkage of the soil under the tyre's lowest point [m].
  double sinkage = 0;
  /// Mean pressure over the patch [Pa].
  double pressure = 0;
  /// Distance from the middle to where the round tread leaves the ground [m].
  double half_length = 0;

  /// Returns the depth [m] of the tread below the undisturbed surface at `ahead` [m] from the
  /// middle, in either direction: the tyre's circle flattened by its deflection, 0 where it has
  /// left the ground.
  double tread_depth(double ahead) const;
};

/// Computes the patch under a wheel (or twin pair) that carries `load` [N] on `soil`.
///
/// The mean pressure is p = load / (l b) on a length l = 2 sqrt(2 r (deflection + z / 2)), the
/// sinkage z follows from the plate's law [Bekker 1969]. Sinking lengthens the patch, which lowers
/// the pressure, so both are solved together. Without a positive load all lengths are 0.
TyrePatch tyre_patch(const scene::Wheel& tyre, const scene::Soil& soil, double load);

}  // namespace navvy::terramechanics
