// SPDX-License-Identifier: Apache-2.0
// Parameters of a scene: all values that influence a run, by name.
#pragma once

#include <map>
#include <string>

#include "scene/scene.h"

namespace navvy::scene {

/// Maps the path of a parameter, such as "soil[loam]/cohesion_pa", to its value as text in the unit
/// of the file, precise to the last bit.
using Parameters = std::map<std::string, std::string>;

/// Returns the parameters of a scene: soils, ground, solver, and machines with their poses and
/// programs. Cameras, lights, colors, file names, durations, the design and records do not
/// influence the motion and are left out. Takes a few milliseconds.
Parameters parameters(const Scene& scene);

/// Returns the differences between two sets of parameters as "path: 'value in before', here 'value
/// in now'", separated by "; ". It lists at most `most` differences, then the number of the
/// remaining ones. Returns an empty text if the sets are equal.
std::string differences(const Parameters& before, const Parameters& now, int most = 8);

}  // namespace navvy::scene
