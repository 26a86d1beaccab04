// SPDX-License-Identifier: Apache-2.0
#include "scene_io/raster_reader.h"

#include <filesystem>

#include "scene_io/mesh_path.h"

namespace navvy::scene_io {

void read_raster_scale(Fields& fields, scene::RasterScale& scale) {
  Vec2 heights = Vec2::Zero();
  // Which of them a file may have is known when it is opened.
  fields.number("map_cell_m", scale.cell, {0.001, 1e4})
      .vec2("map_heights_m", heights, {-12000, 12000})
      .vec2("map_corner_m", scale.corner, {-1e9, 1e9})
      .choice<bool>("map_rows", scale.north_first, {{"south_first", false}, {"north_first", true}});
  scale.has_heights = fields.has("map_heights_m");
  scale.has_corner = fields.has("map_corner_m");
  scale.low = heights.x();
  scale.high = heights.y();
}

void resolve_raster(const Element& element, std::string& path, Faults& faults) {
  if (path.empty()) return;
  const bool from_scene = element.GetLineNum() > 0;
  std::filesystem::path full = path;
  if (from_scene && full.is_relative())
    full = std::filesystem::path(Document::of(element).directory()) / full;
  path = full.string();
  std::error_code failed;
  if (!std::filesystem::is_regular_file(full, failed))
    faults.error(element, text_of(element), why_no_file(path),
                 from_scene ? "paths count from the scene file"
                            : "on the command line paths count from this directory");
}

}  // namespace navvy::scene_io
