// SPDX-License-Identifier: Apache-2.0
#include "scene_io/shell_reader.h"

#include <algorithm>

#include "core/limits.h"
#include "geometry/topology.h"
#include "scene_io/element_reader.h"
#include "scene_io/mesh_path.h"

namespace navvy::scene_io {

namespace {

std::string corners_text(const std::array<int, 3>& t) {
  return std::to_string(t[0]) + " " + std::to_string(t[1]) + " " + std::to_string(t[2]);
}

/// Turns the flat lists of an element into vertices [m] and triangles. Numbers beyond the last
/// whole triple have been reported and are left out.
void read_triangles(Element& element, const std::vector<double>& vertices,
                    const std::vector<double>& corners, scene::Shell& shell, Faults& faults) {
  if (vertices.size() % 3 != 0)
    faults.error(element, "", "vertices_m must hold 3 numbers a vertex",
                 "complete the last vertex, or remove it");
  if (corners.size() % 3 != 0)
    faults.error(element, "", "triangles must hold 3 vertex indices a triangle",
                 "complete the last triangle, or remove it");
  for (std::size_t i = 0; i + 2 < vertices.size(); i += 3)
    shell.vertices.emplace_back(vertices[i], vertices[i + 1], vertices[i + 2]);
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
    shell.triangles.push_back({static_cast<int>(corners[i]), static_cast<int>(corners[i + 1]),
                               static_cast<int>(corners[i + 2])});
}

/// The solver needs areas, and one side that is the inside: two triangles run along a shared edge
/// in opposite directions.
void check_surface(const Element& element, const scene::Shell& shell, Faults& faults) {
  for (std::size_t n = 0; n < shell.triangles.size(); ++n)
    // 1e-10 m2 is a square of 10 micrometres; the comparison is also false for NaN.
    if (!(shell.area_vector(n).norm() > 1e-10))
      faults.error(element, corners_text(shell.triangles[n]),
                   "triangle " + std::to_string(n) + " has no area",
                   "remove it or correct its corners");
  if (const auto clash = geometry::find_winding_clash(shell))
    faults.error(element, corners_text(shell.triangles[clash->second]),
                 "triangles " + std::to_string(clash->first) + " and " +
                     std::to_string(clash->second) +
                     " are wound against each other along their edge",
                 "wind the whole shell alike: counter-clockwise as seen from the inside");
}

}  // namespace

void finish_shell(Element& element, scene::Shell& shell, Faults& faults) {
  const bool inline_given = has(element, "vertices_m") && has(element, "triangles");
  if (has(element, "mesh") == inline_given)
    faults.error(element, "", "needs either <mesh> or <vertices_m> with <triangles>",
                 "give one of them");
  if (inline_given)
    read_triangles(element, shell.vertex_numbers, shell.corner_numbers, shell, faults);
  // The numbers were only needed for reading; shells are copied with every machine.
  shell.vertex_numbers.clear();
  shell.corner_numbers.clear();
  std::string path;
  if (Element* child = element.FirstChildElement("mesh");
      child && resolve_mesh(*child, path, faults))
    read_shell_mesh(path, *child, shell, faults);
  if (shell.triangles.size() > limits::kShellTriangles) {
    faults.error(element, std::to_string(shell.triangles.size()) + " triangles",
                 "a shell may have at most " + std::to_string(limits::kShellTriangles) +
                     ": soil near it is checked against each",
                 "simplify the mesh; visuals may keep theirs");
    shell.triangles.clear();
    return;
  }
  // Indices from the file are checked before any triangle is used to address a vertex.
  const int count = static_cast<int>(shell.vertices.size());
  for (const auto& t : shell.triangles) {
    const bool inside =
        std::all_of(t.begin(), t.end(), [count](int i) { return i >= 0 && i < count; });
    if (inside && t[0] != t[1] && t[1] != t[2] && t[0] != t[2]) continue;
    faults.error(
        element, corners_text(t),
        "a triangle must name three different vertices from 0 to " + std::to_string(count - 1));
    shell.triangles.clear();
    return;
  }
  // An empty shell with neither form has been reported above.
  if (shell.triangles.empty() && (inline_given || !path.empty()))
    faults.error(element, "", "holds no triangle");
  check_surface(element, shell, faults);
}

}  // namespace navvy::scene_io
