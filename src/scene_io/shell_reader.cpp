// SPDX-License-Identifier: Apache-2.0
#include "scene_io/shell_reader.h"

#include <algorithm>

#include "core/limits.h"
#include "geometry/topology.h"
#include "scene_io/fields.h"
#include "scene_io/mesh_path.h"

namespace navvy::scene_io {

namespace {

void read_triangles(Element& element, const std::vector<double>& vertices,
                    const std::vector<double>& corners, scene::Shell& shell, Faults& faults) {
  if (vertices.size() % 3 != 0)
    faults.error(element, "", "vertices_m must hold 3 numbers a vertex");
  if (corners.size() % 3 != 0)
    faults.error(element, "", "triangles must hold 3 vertex indices a triangle");
  for (std::size_t i = 0; i + 2 < vertices.size(); i += 3)
    shell.vertices.emplace_back(vertices[i], vertices[i + 1], vertices[i + 2]);
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
    shell.triangles.push_back({static_cast<int>(corners[i]), static_cast<int>(corners[i + 1]),
                               static_cast<int>(corners[i + 2])});
}

/// The solver needs areas, and one side that is the inside: two triangles run along a shared edge
/// in opposite directions.
void check_surface(const Element& element, const scene::Shell& shell, Faults& faults) {
  const auto named = [&](std::size_t n) {
    const std::array<int, 3>& t = shell.triangles[n];
    return std::to_string(t[0]) + " " + std::to_string(t[1]) + " " + std::to_string(t[2]);
  };
  for (std::size_t n = 0; n < shell.triangles.size(); ++n)
    if (!(shell.area_vector(n).norm() > 1e-10))
      faults.error(element, named(n), "triangle " + std::to_string(n) + " has no area",
                   "remove it or mend its corners");
  if (const auto clash = geometry::find_winding_clash(shell))
    faults.error(element, named(clash->second),
                 "triangles " + std::to_string(clash->first) + " and " +
                     std::to_string(clash->second) +
                     " are wound against each other along their edge",
                 "wind the whole shell alike: counter-clockwise as seen from the inside");
}

}  // namespace

scene::Shell read_shell(Element& element, const Names& names, Faults& faults) {
  scene::Shell shell;
  shell.name = attribute(element, "name");
  require_attribute_name(element, faults);
  std::string mesh;
  std::vector<double> vertices, corners;
  Fields fields(element, faults);
  fields.attribute("name")
      .text("link", shell.link)
      .required("link")
      .text("mesh", mesh)
      .list("vertices_m", vertices, {-1000, 1000})
      .list("triangles", corners, {0, 1e6})
      .number("half_thickness_m", shell.half_thickness, {1e-4, 1})
      .number("friction_share", shell.friction_share, {0, 2})
      .number("adhesion_share", shell.adhesion_share, {0, 2})
      .finish();
  require_name(element, "link", "link", names.links, faults);
  const bool inline_given = fields.has("vertices_m") && fields.has("triangles");
  if (fields.has("mesh") == inline_given)
    faults.error(element, "", "needs either <mesh> or <vertices_m> with <triangles>");
  if (inline_given) read_triangles(element, vertices, corners, shell, faults);
  std::string path;
  if (Element* child = fields.child("mesh"); child && resolve_mesh(*child, path, faults))
    read_shell_mesh(path, *child, shell, faults);
  if (shell.triangles.size() > limits::kShellTriangles) {
    faults.error(element, std::to_string(shell.triangles.size()) + " triangles",
                 "a shell may have at most " + std::to_string(limits::kShellTriangles) +
                     ": the soil near it is held against each",
                 "thin the mesh out; what is drawn may stay as fine as it is");
    shell.triangles.clear();
    return shell;
  }
  for (const auto& triangle : shell.triangles) {
    const int count = static_cast<int>(shell.vertices.size());
    const bool inside =
        std::all_of(triangle.begin(), triangle.end(), [&](int i) { return i >= 0 && i < count; });
    if (!inside || triangle[0] == triangle[1] || triangle[1] == triangle[2] ||
        triangle[0] == triangle[2]) {
      faults.error(
          element,
          std::to_string(triangle[0]) + " " + std::to_string(triangle[1]) + " " +
              std::to_string(triangle[2]),
          "a triangle must name three different vertices from 0 to " + std::to_string(count - 1));
      shell.triangles.clear();
      return shell;
    }
  }
  if (shell.triangles.empty() && (inline_given || !path.empty()))
    faults.error(element, "", "holds no triangle");
  check_surface(element, shell, faults);
  return shell;
}

}  // namespace navvy::scene_io
