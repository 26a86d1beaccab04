// SPDX-License-Identifier: Apache-2.0
// Parameters of a scene: every value that a run depends on, by name.
#pragma once

#include <map>
#include <string>

#include "scene/scene.h"

namespace navvy::scene {

/// Values as text in the unit of the file, exact to the last bit, by paths such as
/// "soil[loam]/cohesion_pa".
using Parameters = std::map<std::string, std::string>;

/// Returns the parameters of a scene: soils, ground, solver, machines, their places and programs.
/// Cameras, lights, colors, names of files, durations, the design and records are left out, as they
/// do not influence the motion. It takes a few milliseconds.
Parameters parameters(const Scene& scene);

/// Returns the differences as "path: 'before', here 'now'", separated by "; ": the first `most` of
/// them and the number of the others. Returns an empty text for equal parameters.
std::string differences(const Parameters& before, const Parameters& now, int most = 8);

}  // namespace navvy::scene
