// SPDX-License-Identifier: Apache-2.0
// Every value of a scene that decides how a run of it goes, by name: to hash it, and to tell how
// two scenes differ.
#pragma once

#include <map>
#include <string>

#include "scene/scene.h"

namespace navvy::scene {

/// Values as text with all their digits, in SI units, by paths such as "soil[loam]/cohesion".
using Parameters = std::map<std::string, std::string>;

/// Of soils, ground, solver, machines, where they stand and what they shall do. Left out is what a
/// run only shows or records (cameras, lights, colours, pictures of links, names of files, how long
/// it lasts, design and maps). Steps of a program that no file described count by their kind alone.
/// Costs a few milliseconds.
Parameters parameters(const Scene& scene);

/// What differs, "path: 'before', here 'now'", separated by "; "; the first `most` of them and how
/// many more there are. Empty when nothing does.
std::string differences(const Parameters& before, const Parameters& now, int most = 8);

}  // namespace navvy::scene
