// SPDX-License-Identifier: Apache-2.0
// Maps of what is not running: a site, and what a run left.
#pragma once

#include <string>

#include "planner/map_maker.h"
#include "scene/scene.h"

namespace navvy::planner {

/// Limits of the first machine of the scene that gives some (navvy:traversability), else the defaults.
TraversabilityLimits limits_for(const scene::Scene& scene);

/// Gives `options` the scene's design surface on the columns of `site`, where a layer asks for one and there is none
/// yet. @throws InputError as heightfield::make_design.
void take_design(const scene::Scene& scene, const heightfield::Terrain& site, MapOptions& options);

// Both with the scene's design; limits are those of `options`.
/// The untouched site of a scene. Needs no OpenCL device.
/// @throws InputError as heightfield::make_ground and make_design.
TerrainMap map_of_site(const scene::Scene& scene, const MapOptions& options);

/// The ground at the end of a run of `scene`, from the heights that the run wrote (`terrain_end.tif`): elevation and
/// what follows from it, elevation_start, and target. The file tells neither soil nor density, nor what lies loose or
/// when it changed: those are unknown. Columns that did not change have the start's very heights; others are rounded as
/// the file rounds them. The time is unknown, NaN.
/// @throws FileError when the file is missing, InputError when it is no map of that site.
TerrainMap map_of_run(const scene::Scene& scene, const std::string& terrain_end, const MapOptions& options);

}  // namespace navvy::planner
