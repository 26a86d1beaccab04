// SPDX-License-Identifier: Apache-2.0
// Contact patch of a tyre in soft ground: its length, pressure and sinkage.
#pragma once

#include "scene/machine.h"
#include "scene/soil.h"

namespace navvy::terramechanics {

/// Returns the length [m] of the chord of a circle of `radius` r that is `depth` d above the
/// circle's lowest point [m]: 2 sqrt(2 r d), an approximation for d << r. Returns 0 for a negative
/// depth.
double chord_length(double radius, double depth);

/// Contact patch of one tyre in soft ground. Both tyres of a twin pair have the same patch, each
/// with half the pair's load.
struct TyrePatch {
  /// Radius and width of the tyre [m].
  double radius = 0, width = 0;
  /// Static radial deflection of the tyre [m]: load of the wheel (of both tyres of a pair) divided
  /// by its stiffness.
  double deflection = 0;
  /// Depth of the patch below the undisturbed surface [m].
  double sinkage = 0;
  /// Mean pressure over the patch [Pa].
  double pressure = 0;
  /// Distance along the wheel's path from the middle of the patch to where the round tread leaves
  /// the ground [m].
  double half_length = 0;

  /// Returns the depth [m] of the tread below the undisturbed surface at the distance `ahead` [m]
  /// before or behind the middle of the patch. The tread is the tyre's circle, flattened by its
  /// deflection; the depth is 0 where it has left the ground.
  double tread_depth(double ahead) const;
};

/// Returns the contact patch of each tyre of a wheel (single or twin) that carries `load` [N] on
/// `soil`.
///
/// The mean pressure is p = load / (l b) on the length l = 2 sqrt(2 r (deflection + z / 2)), with
/// the load of one tyre and its width b. The sinkage z follows from p by the plate law
/// [Bekker 1969]. Sinking lengthens the patch, which lowers the pressure, so both are solved
/// together by iteration. For a load <= 0 everything but radius and width is 0.
TyrePatch tyre_patch(const scene::Wheel& tyre, const scene::Soil& soil, double load);

}  // namespace navvy::terramechanics
