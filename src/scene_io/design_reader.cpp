// SPDX-License-Identifier: Apache-2.0
#include "scene_io/design_reader.h"

#include <optional>
#include <utility>

#include "scene/polygon.h"
#include "scene_io/element_reader.h"
#include "scene_io/ground_reader.h"
#include "scene_io/landxml.h"

namespace navvy::scene_io {
namespace {

void finish_area(const Element& element, scene::DesignArea& area, Faults& faults) {
  area.line = element.GetLineNum();
  const Element* polygon = element.FirstChildElement("polygon_m");
  if (polygon == nullptr) return;
  const std::vector<double> numbers = std::move(area.polygon_numbers);
  area.polygon = polygon_of(*polygon, numbers, faults);
  if (area.polygon.empty()) return;
  if (const Element* depth = element.FirstChildElement("depth_m"); depth && area.depth == 0)
    faults.error(*depth, "0", "a pit is deeper than 0, a pad less", "0.8 digs, -0.8 fills");
}

}  // namespace

std::vector<Vec2> polygon_of(const Element& at, const std::vector<double>& numbers,
                             Faults& faults) {
  std::vector<Vec2> polygon;
  if (const std::optional<scene::PolygonFault> fault = scene::polygon_of(numbers, polygon))
    faults.error(at, fault->value, fault->rule, fault->remedy);
  return polygon;
}

scene::Design read_design(Element& element, Faults& faults) {
  scene::Design design;
  read_element(element, design, nullptr, faults);
  design.scale.take_heights();
  std::size_t i = 0;
  for (const Element* area : children_of(element, {"area"}))
    finish_area(*area, design.areas[i++], faults);
  if (design.file.empty() == design.areas.empty())
    faults.error(element, design.file, "needs either a <file> or an <area>",
                 "remove one of them, or add one");
  if (design.file.empty()) return design;
  const Element& file = *element.FirstChildElement("file");
  design.file_line = file.GetLineNum();
  const std::size_t before = faults.error_count();
  resolve_raster(file, design.file, faults);
  // Only plain files are opened: a pipe would wait for its writer for ever.
  if (faults.error_count() > before) return design;
  const bool landxml = is_landxml(design.file);
  if (landxml) design.tin = read_landxml(design.file, design.surface, faults);
  if (landxml && design.scale.any())
    faults.error(file, text_of(file),
                 "map_cell_m, map_heights_m, map_corner_m and map_rows are for PNG and NPY only",
                 "remove them: LandXML holds its own unit and coordinates");
  if (const Element* surface = element.FirstChildElement("surface"); surface && !landxml)
    faults.error(*surface, design.surface, "only LandXML has surfaces by name", "remove it");
  return design;
}

}  // namespace navvy::scene_io
