// SPDX-License-Identifier: Apache-2.0
// Checks of the machines' first second, which need neither a run nor a device.
#pragma once

#include <string>
#include <vector>

#include "core/error.h"
#include "core/math.h"
#include "heightfield/layered_ground.h"
#include "scene/scene.h"
#include "vehicle/machine_state.h"

namespace navvy::sim {

/// Returns an error for every pair of machines, at least one of them dynamic, whose collision
/// shapes overlap by more than 2 cm at the start. Shapes are taken as boxes. The error names both
/// links and the depth of the overlap [m]. Pairs that are hitched together are skipped. `X_WB`
/// holds the initial pose of each machine's base link, in the scene's order.
std::vector<Fault> check_overlaps(const scene::Scene& scene, const std::vector<Pose>& X_WB);

/// Returns an error for every dynamic machine of which a wheel's centre, or the centre of a moving
/// link's collision shape, is more than 2 cm below the surface of `ground` at the start. Such a
/// machine would fall through the ground or be thrown out of it. `X_WB` holds the initial pose of
/// each machine's base link, in the scene's order.
std::vector<Fault> check_buried(const scene::Scene& scene, const std::vector<Pose>& X_WB,
                                const heightfield::Terrain& ground);

/// Returns a warning for every link that forces move whose inertia is less than 1 % of that of a
/// solid body of its collision shapes, and for every two bodies of which the upper one rests on the
/// lower one at the start and has more than 200 times its mass: contacts do not carry such bodies.
/// `X_WB` holds the initial pose of each machine's base link, in the scene's order.
std::vector<Fault> check_bodies(const scene::Scene& scene, const std::vector<Pose>& X_WB);

/// Result of check_start: the errors found at the start of a scene, and the state of each machine
/// after the first second.
struct StartCheck {
  /// Stability of each machine of the scene after the first second; empty if a machine starts
  /// inside the ground.
  std::vector<vehicle::Stability> standing;
  /// One entry per machine of the scene: true if the machine is still falling after the first
  /// second. Empty if a machine starts inside the ground.
  std::vector<bool> falling;
  /// One entry per machine of the scene: how it stands, for a dynamic machine of several links
  /// without wheels that is not fixed to the world; empty for all others.
  std::vector<std::string> without_wheels;
  /// Errors found: machines that overlap, start inside the ground or tip over, and a ground that
  /// cannot be built; and warnings for machines that are thrown up.
  std::vector<Fault> faults;
  /// Report on the map of the ground, in one or more lines; empty if the scene has no map.
  std::string terrain;
  /// One-line comparison of the design surface with the untouched site; empty if the scene has no
  /// design.
  std::string design;
};

/// Builds the ground of the scene, places the machines on it and simulates one second in which the
/// soil stays at rest and all joints are held. Errors are returned in StartCheck::faults; an
/// invalid scene does not cause an exception.
StartCheck check_start(const scene::Scene& scene);

}  // namespace navvy::sim
