// SPDX-License-Identifier: Apache-2.0
// Parameters of a scene: every value that a run depends on, by name.
#pragma once

#include <map>
#include <string>

#include "scene/scene.h"

namespace navvy::scene {

/// Values of a scene, keyed by paths such as "soil[loam]/cohesion_pa". The values are texts in the
/// unit of the scene file, without loss of precision.
using Parameters = std::map<std::string, std::string>;

/// Returns every value of the scene that influences the motion: soils, ground, solver, machines
/// with their poses and programs. Cameras, lights, colors, file names, durations, the design and
/// records are left out. Takes a few milliseconds.
Parameters parameters(const Scene& scene);

/// Returns the differences between two sets of parameters as text, "path: 'before', here 'now'",
/// separated by "; ". The text lists the first `most` differences and counts the others; it is
/// empty if there are none.
std::string differences(const Parameters& before, const Parameters& now, int most = 8);

}  // namespace navvy::scene
