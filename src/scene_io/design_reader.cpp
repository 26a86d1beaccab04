// SPDX-License-Identifier: Apache-2.0
#include "scene_io/design_reader.h"

#include <algorithm>
#include <utility>

#include "core/limits.h"
#include "scene_io/element_reader.h"
#include "scene_io/ground_reader.h"
#include "scene_io/landxml.h"

namespace navvy::scene_io {
namespace {

/// Returns the side of the line a-b on which c is: above 0 left, 0 on it.
double side(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// Returns true if two edges without a common corner meet.
/// The boxes of the edges decide where all four points are on one line, which the signs cannot.
bool cross(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  return side(a, b, c) * side(a, b, d) <= 0 && side(c, d, a) * side(c, d, b) <= 0 &&
         std::max(a.x(), b.x()) >= std::min(c.x(), d.x()) &&
         std::max(c.x(), d.x()) >= std::min(a.x(), b.x()) &&
         std::max(a.y(), b.y()) >= std::min(c.y(), d.y()) &&
         std::max(c.y(), d.y()) >= std::min(a.y(), b.y());
}

/// An area needs an inside: separate corners, and edges that meet at their corners only.
void check_polygon(const Element& at, const std::vector<Vec2>& polygon, Faults& faults) {
  const std::size_t n = polygon.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 &a = polygon[i], &b = polygon[(i + 1) % n];
    // The sides of the area rise from its edges; one shorter than 1 mm has no reliable direction.
    if ((b - a).norm() < 1e-3) {
      faults.error(at, std::to_string(i + 1), "this corner and the next are the same place",
                   "remove one; the polygon closes by itself");
      return;
    }
    // Neighbouring edges share a corner and are left out, the first and the last one too.
    for (std::size_t k = i + 2; k < n && !(i == 0 && k == n - 1); ++k)
      if (cross(a, b, polygon[k], polygon[(k + 1) % n])) {
        faults.error(at, std::to_string(i + 1) + " and " + std::to_string(k + 1),
                     "the edges that begin at these corners cross",
                     "list the corners once round the area");
        return;
      }
  }
}

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
  if (numbers.size() < 6 || numbers.size() % 2 != 0 ||
      numbers.size() > 2 * limits::kDesignCorners) {
    faults.error(
        at, std::to_string(numbers.size()) + " numbers",
        "a polygon is x and y of 3 to " + std::to_string(limits::kDesignCorners) + " corners",
        "e.g. 0 0 4 0 4 2 0 2");
    return polygon;
  }
  for (std::size_t i = 0; i < numbers.size(); i += 2)
    polygon.emplace_back(numbers[i], numbers[i + 1]);
  check_polygon(at, polygon, faults);
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
