// SPDX-License-Identifier: Apache-2.0
// What ground and design have in common: a file beside the scene, and what pictures and arrays
// leave open.
#pragma once

#include <string>

#include "scene/ground.h"
#include "scene_io/fields.h"

namespace navvy::scene_io {

/// Takes map_cell_m, map_heights_m (low high), map_corner_m and map_rows from a table.
void read_raster_scale(Fields& fields, scene::RasterScale& scale);

/// Turns the name in `element` into a path: one in a scene counts from the scene's file, one from
/// the command line from the working directory. A file that is not there is a fault.
void resolve_raster(const Element& element, std::string& path, Faults& faults);

}  // namespace navvy::scene_io
