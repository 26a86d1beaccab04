// SPDX-License-Identifier: Apache-2.0
#include "geometry/triangle_mesh.h"

#include <algorithm>
#include <map>

#include "core/error.h"

namespace navvy::geometry {
namespace {

/// Faults name the part by its index in the mesh; only the reader knows a file's lines.
[[noreturn]] void refuse(const std::string& name, const std::string& part, std::size_t number,
                         const std::string& rule) {
  Fault fault;
  fault.element = name + "/" + part + "[" + std::to_string(number) + "]";
  fault.rule = rule;
  fault.remedy = "export the mesh again";
  throw InputError(fault);
}

}  // namespace

// Unused vertices count, as shells and hulls use all of them.
Box bounds(const TriangleMesh& mesh) {
  Box box;
  if (mesh.vertices.empty()) return box;
  box.low = box.high = mesh.vertices.front();
  for (const Vec3& v : mesh.vertices) {
    box.low = box.low.cwiseMin(v);
    box.high = box.high.cwiseMax(v);
  }
  return box;
}

void require_valid(const TriangleMesh& mesh, const std::string& name) {
  // A single NaN would pass comparisons with boxes and planes unnoticed.
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    if (!mesh.vertices[v].allFinite())
      refuse(name, "vertex", v, "coordinates must be finite numbers");
  const int count = static_cast<int>(mesh.vertices.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const int v : mesh.triangles[t])
      if (v < 0 || v >= count)
        refuse(name, "triangle", t,
               "a corner names vertex " + std::to_string(v) + " of " + std::to_string(count));
  // Materials are stored in a list beside the triangles; a list of another length would shift all
  // colours.
  if (mesh.material_of.empty()) return;
  const int materials = static_cast<int>(mesh.materials.size());
  if (mesh.material_of.size() != mesh.triangles.size())
    refuse(name, "triangle", std::min(mesh.material_of.size(), mesh.triangles.size()),
           "every triangle needs a material, or none has one");
  for (std::size_t t = 0; t < mesh.material_of.size(); ++t)
    if (mesh.material_of[t] < -1 || mesh.material_of[t] >= materials)
      refuse(name, "triangle", t,
             "names material " + std::to_string(mesh.material_of[t]) + " of " +
                 std::to_string(materials));
}

TriangleMesh welded(const TriangleMesh& mesh) {
  TriangleMesh out = mesh;
  out.vertices.clear();
  // Exactly the same place: the result of a tolerance would depend on the order of the vertices.
  std::map<std::array<double, 3>, int> number;
  std::vector<int> merged;
  merged.reserve(mesh.vertices.size());
  for (const Vec3& v : mesh.vertices) {
    // Minus zero equals zero; adding zero makes them one key.
    const std::array<double, 3> place = {v.x() + 0.0, v.y() + 0.0, v.z() + 0.0};
    const auto [at, is_new] = number.try_emplace(place, static_cast<int>(out.vertices.size()));
    // The first vertex is kept, so that welding a mesh without duplicates changes nothing.
    if (is_new) out.vertices.push_back(v);
    merged.push_back(at->second);
  }
  for (auto& triangle : out.triangles)
    for (int& v : triangle) v = merged[static_cast<std::size_t>(v)];
  return out;
}

}  // namespace navvy::geometry
