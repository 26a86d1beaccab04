// SPDX-License-Identifier: Apache-2.0
#include "geometry/formats/mesh_builder.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/error.h"
#include "core/file.h"
#include "core/limits.h"

namespace navvy::geometry {

void refuse_mesh(const std::string& path, int line, const std::string& value,
                 const std::string& rule, const std::string& remedy) {
  throw InputError(Fault{Fault::Severity::kError, path, line, "", value, rule, remedy});
}

std::string mesh_bytes(const std::string& path) {
  try {
    const std::vector<char> bytes = read_file(path, limits::kObjBytes);
    return std::string(bytes.begin(), bytes.end());
  } catch (const FileError& failure) {
    std::error_code unknown;
    if (!std::filesystem::exists(path, unknown)) throw;
    refuse_mesh(path, 0, "", failure.what(), "name a mesh file of at most 64 MB");
  }
}

int MeshBuilder::vertex(const Vec3& p) {
  if (!p.allFinite() || p.cwiseAbs().maxCoeff() > limits::kCoordinate)
    refuse_mesh(path_, 0, "",
                "a vertex needs three finite coordinates of at most " +
                    std::to_string(static_cast<long>(limits::kCoordinate)) + " m");
  const auto [at, is_new] =
      places_.try_emplace({p.x(), p.y(), p.z()}, static_cast<int>(mesh_.vertices.size()));
  if (is_new) mesh_.vertices.push_back(p);
  return at->second;
}

void MeshBuilder::add(const Vec3& a, const Vec3& b, const Vec3& c, int material) {
  const std::array<int, 3> corners = {vertex(a), vertex(b), vertex(c)};
  if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) return;
  if (mesh_.triangles.size() >= limits::kObjTriangles)
    refuse_mesh(path_, 0, "",
                "a mesh may have at most " + std::to_string(limits::kObjTriangles) + " triangles",
                "export it with fewer");
  mesh_.triangles.push_back(corners);
  mesh_.material_of.push_back(material);
}

int MeshBuilder::add_material(const MeshMaterial& material) {
  const auto same = [&](const MeshMaterial& m) {
    return m.diffuse == material.diffuse && m.specular == material.specular &&
           m.shininess == material.shininess && m.opacity == material.opacity;
  };
  auto& all = mesh_.materials;
  const auto found = std::find_if(all.begin(), all.end(), same);
  if (found != all.end()) return static_cast<int>(found - all.begin());
  // A picture needs no more colors than it can show apart.
  constexpr std::size_t kMost = 4096;
  if (all.size() >= kMost) return -1;
  all.push_back(material);
  return static_cast<int>(all.size()) - 1;
}

TriangleMesh MeshBuilder::finish() {
  if (mesh_.triangles.empty()) refuse_empty_mesh(path_);
  if (mesh_.materials.empty()) mesh_.material_of.clear();
  require_valid(mesh_, path_);
  return std::move(mesh_);
}

}  // namespace navvy::geometry
