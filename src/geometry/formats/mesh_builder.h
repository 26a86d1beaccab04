// SPDX-License-Identifier: Apache-2.0
// Collects the triangles that readers of mesh formats find, within the limits of files.
#pragma once

#include <map>
#include <string>
#include <tuple>

#include "core/error.h"
#include "geometry/triangle_mesh.h"

namespace navvy::geometry {

/// Reports an error in a mesh file; never returns. Line 0: the error belongs to no line.
/// @throws InputError, always
[[noreturn]] void refuse_mesh(const std::string& path, int line, const std::string& value,
                              const std::string& rule,
                              const std::string& remedy = "export the mesh again");

/// Reports a mesh file without triangles; never returns. Defined here because the slim build, which
/// reads OBJ files only, has no mesh_builder.cpp.
/// @throws InputError, always
[[noreturn]] inline void refuse_empty_mesh(const std::string& path) {
  throw InputError(
      Fault{Fault::Severity::kError, path, 0, "", "0 triangles",
            "a mesh needs at least one triangle with an area, and this file shows none",
            "export the mesh with its faces, or name another file"});
}

/// Returns the bytes of a mesh file. @throws FileError if it does not exist, InputError if it is
/// too large or cannot be read
std::string mesh_bytes(const std::string& path);

/// A mesh that grows triangle by triangle. Equal vertices are merged, and so are equal materials.
class MeshBuilder {
 public:
  /// @param path name of the file, for messages; must outlive the builder
  explicit MeshBuilder(const std::string& path) : path_(path) {}

  /// Adds a triangle; `material` is an index from `add_material`, or -1. Triangles without area are
  /// left out. @throws InputError for a vertex that is not finite and for too many triangles
  void add(const Vec3& a, const Vec3& b, const Vec3& c, int material);
  /// Returns the index of a material, which is new unless an equal one was added before.
  int add_material(const MeshMaterial& material);
  /// Returns the mesh. @throws InputError if it has no triangle
  TriangleMesh finish();

 private:
  int vertex(const Vec3& p);

  const std::string& path_;
  TriangleMesh mesh_;
  std::map<std::tuple<double, double, double>, int> places_;  ///< vertices by position
};

}  // namespace navvy::geometry
