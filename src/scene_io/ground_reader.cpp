// SPDX-License-Identifier: Apache-2.0
#include "scene_io/ground_reader.h"

#include <filesystem>

#include "scene_io/element_reader.h"
#include "scene_io/mesh_path.h"

namespace navvy::scene_io {

namespace {

/// Only the last layer of a list leaves out its thickness: it reaches to the bottom.
void check_layers(Element& parent, const std::vector<scene::GroundLayer>& layers, Faults& faults) {
  const std::vector<Element*> elements = children_of(parent, {"layer"});
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const Element* thickness = elements[i]->FirstChildElement("thickness_m");
    const bool last = i + 1 == elements.size();
    if (thickness == nullptr && !last)
      faults.error(*elements[i], layers[i].soil,
                   "needs <thickness_m>; only the last layer reaches to the bottom by itself");
    if (thickness != nullptr && last)
      faults.warning(*thickness, text_of(*thickness),
                     "the last layer reaches to the rock whatever its thickness",
                     "name the soil below in a <layer> of its own, or remove the thickness");
  }
}

/// Checks that a rectangle has an area; its corners are in the world [m].
void check_rectangle(const Element& element, const Vec2& low, const Vec2& high, Faults& faults) {
  if (low.x() >= high.x() || low.y() >= high.y())
    faults.error(element, "", "min_m must be less than max_m in x and y",
                 "give the lower left corner in min_m");
}

void check_rectangles(Element& element, const scene::StartGround& ground, Faults& faults) {
  // `ElementReader::list` fills each vector in the order of its elements.
  std::size_t i = 0;
  for (Element* patch : children_of(element, {"patch"})) {
    check_rectangle(*patch, ground.patches[i].min, ground.patches[i].max, faults);
    check_layers(*patch, ground.patches[i++].layers, faults);
  }
  i = 0;
  for (Element* active : children_of(element, {"active"})) {
    check_rectangle(*active, ground.active[i].min, ground.active[i].max, faults);
    ++i;
  }
}

/// Checks elements that exclude each other: those of a map and those of a procedural ground.
void check_map(const Element& element, const scene::StartGround& ground, Faults& faults) {
  if (has(element, "at_m") && ground.at_is_local)
    faults.error(*element.FirstChildElement("at_local_m"), "", "give either at_m or at_local_m",
                 "remove one");
  if (!ground.file.empty() && !ground.features.empty())
    faults.error(element, ground.file,
                 "shapes such as slope or hills need a procedural ground, not a file",
                 "remove <file> or the shapes");
  if (ground.file.empty() && ground.scale.any())
    faults.error(element, "", "map_cell_m, map_heights_m, map_corner_m and map_rows need a <file>",
                 "remove them, or name a PNG or NPY");
  if (ground.file.empty() && ground.has_at)
    faults.error(element, "", "at_m and at_local_m need a <file>",
                 "for a procedural ground use origin_m");
}

}  // namespace

void resolve_raster(const Element& element, std::string& path, Faults& faults) {
  if (path.empty()) return;
  // An element from the command line has line 0, and its author thinks of the working directory.
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

scene::StartGround read_ground(Element& element, const std::vector<scene::Soil>& soils,
                               std::uint64_t seed, Faults& faults) {
  scene::StartGround ground;
  Names names;
  names.soils = names_in_list(soils);
  read_element(element, ground, &names, faults);
  // at_local_m is read into the same point and differs in its frame only.
  ground.has_at = ground.has_at || ground.at_is_local;
  ground.scale.take_heights();
  // By default the middle of the site is the world's origin.
  if (!ground.has_origin) ground.origin = -0.5 * ground.size;
  // A seed of its own keeps hills as they are when the seed of the scene changes.
  for (scene::GroundFeature& shape : ground.features)
    if (!shape.has_seed) shape.seed = seed;
  if (const Element* file = element.FirstChildElement("file")) {
    ground.file_line = file->GetLineNum();
    resolve_raster(*file, ground.file, faults);
  }
  check_layers(element, ground.layers, faults);
  check_rectangles(element, ground, faults);
  check_map(element, ground, faults);
  // With one soil there is no choice. With several, no order of theirs could be meant by default.
  if (ground.layers.empty() && soils.size() == 1)
    ground.layers.push_back({soils[0].name, ground.depth});
  if (ground.layers.empty() && soils.size() > 1)
    faults.error(element, "", "needs <layer> elements, as the world has several soils",
                 "e.g. <layer><soil>" + soils[0].name + "</soil></layer>");
  return ground;
}

}  // namespace navvy::scene_io
