// SPDX-License-Identifier: Apache-2.0
// Maps of a scene that is not running: of its untouched site, and of the terrain at the end of a
// run.
#pragma once

#include <string>
#include <vector>

#include "heightfield/design_surface.h"
#include "heightfield/layered_ground.h"
#include "map/map_maker.h"
#include "scene/scene.h"

namespace navvy::map {

/// Returns the limits in the machine's file (navvy:traversability), or the default limits if the
/// file gives none.
TraversabilityLimits limits_of(const scene::Machine& machine);
/// Returns options for maps of `site` with the given layers. The limits are those of the first
/// machine of `scene` that gives some (navvy:traversability), or else the defaults. The design
/// surface is included if one of the layers needs it.
/// @param design design surface of the scene if the caller already has it; null: computed here
/// @throws InputError as heightfield::make_design.
MapOptions options_for(const scene::Scene& scene, const heightfield::Terrain& site,
                       std::vector<MapLayer> layers,
                       const heightfield::DesignSurface* design = nullptr);

/// Returns the map of an untouched site. Needs no OpenCL device. Columns are computed when they are
/// read.
/// @param areas areas that bodies occupy on it; may be null
TerrainMap map_of_site(const heightfield::Ground& site, const MapOptions& options,
                       heightfield::OccupiedAreas areas = {});

/// Returns the map of the ground at the end of a run of `scene`, from the file `terrain_end`
/// (terrain_end.tif) that the run wrote. `start` is the untouched site of the scene.
///
/// Available are elevation, the layers computed from it, elevation_start and target. Layers
/// loose_depth and active come from the file's band `loose_depth`; they are 0 if all soil had come
/// to rest, because the file then has no such band. Soil, density and the time of changes are
/// unknown. Columns that did not change have exactly their initial heights; others are rounded as
/// in the file. The time of the map is NaN.
/// @param areas areas that bodies occupy at the end of the run, as far as they are known; may be
///   null
/// @throws FileError if the file is missing, InputError if it belongs to another site.
TerrainMap map_of_run(const scene::Scene& scene, const heightfield::Ground& start,
                      const std::string& terrain_end, const MapOptions& options,
                      heightfield::OccupiedAreas areas = {});

/// Returns true if a layer has no value in any column. Stops at the first column that has one.
bool unknown_everywhere(const TerrainMap& map, MapLayer layer);

}  // namespace navvy::map
