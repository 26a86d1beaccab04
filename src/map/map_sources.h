// SPDX-License-Identifier: Apache-2.0
// Maps of a scene that is not running: of its untouched site, and of what a run left.
#pragma once

#include <string>
#include <vector>

#include "heightfield/design_surface.h"
#include "heightfield/layered_ground.h"
#include "map/map_maker.h"
#include "scene/scene.h"

namespace navvy::map {

/// Returns the limits that the machine's file gives (navvy:traversability), or the defaults.
TraversabilityLimits limits_of(const scene::Machine& machine);
/// Returns options for maps with `layers`: the limits of the first machine of the scene that gives
/// some (navvy:traversability), else the defaults, and where a layer needs it the design surface of
/// the scene on the columns of `site`. `design`, when given, is used instead of computing it again.
/// @throws InputError as heightfield::make_design.
MapOptions options_for(const scene::Scene& scene, const heightfield::Terrain& site,
                       std::vector<MapLayer> layers,
                       const heightfield::DesignSurface* design = nullptr);

/// Returns the map of an untouched site. Needs no OpenCL device and computes columns when the map
/// is read.
TerrainMap map_of_site(const heightfield::Ground& site, const MapOptions& options);

/// Returns the map of the ground at the end of a run of `scene` that began on `start`, from the
/// heights that the run wrote (`terrain_end.tif`). It has elevation and the layers that follow from
/// it, elevation_start and target. The band `loose_depth` of the file gives loose_depth and active;
/// a run whose soil had all come to rest writes no such band, and both are 0 then. Soil, density
/// and the time of changes are unknown, because the file does not hold them. Columns that did not
/// change have exactly the heights of the start; others are rounded as in the file. The time of the
/// map is NaN.
/// @throws FileError when the file is missing, InputError when it belongs to another site.
TerrainMap map_of_run(const scene::Scene& scene, const heightfield::Ground& start,
                      const std::string& terrain_end, const MapOptions& options);

}  // namespace navvy::map
