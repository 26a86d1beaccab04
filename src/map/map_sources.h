// SPDX-License-Identifier: Apache-2.0
// What maps of a scene hold, and maps of what is not running: a site, and what a run left.
#pragma once

#include <string>
#include <vector>

#include "heightfield/design_surface.h"
#include "heightfield/layered_ground.h"
#include "map/map_maker.h"
#include "scene/scene.h"

namespace navvy::map {

/// What a machine can drive on: as its file gives it (navvy:traversability), or the defaults.
TraversabilityLimits limits_of(const scene::Machine& machine);
/// Options of maps with `layers`: the limits of the first machine of the scene that gives some
/// (navvy:traversability), else the defaults; where a layer asks for it the scene's design surface
/// on the columns of `site`, made here unless somebody has it already. @throws InputError as
/// heightfield::make_design.
MapOptions options_for(const scene::Scene& scene, const heightfield::Terrain& site,
                       std::vector<MapLayer> layers,
                       const heightfield::DesignSurface* design = nullptr);

/// A site that nobody has touched. Needs no OpenCL device, and computes columns when the map is
/// read.
TerrainMap map_of_site(const heightfield::Ground& site, const MapOptions& options);

/// The ground at the end of a run of `scene` that began on `start`, from the heights that the run
/// wrote (`terrain_end.tif`): elevation and what follows from it, elevation_start, target, and of
/// its band `loose_depth` what lies loose, and so awake: nothing where the run wrote no such band,
/// as all of its soil rested. The file tells neither soil nor density, nor when a column changed:
/// those are unknown. Columns that did not change have the start's very heights; others are rounded
/// as the file rounds them. The time is unknown, NaN.
/// @throws FileError when the file is missing, InputError when it is no map of that site.
TerrainMap map_of_run(const scene::Scene& scene, const heightfield::Ground& start,
                      const std::string& terrain_end, const MapOptions& options);

}  // namespace navvy::map
