// SPDX-License-Identifier: Apache-2.0
#include "geometry/read_mesh.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "core/error.h"
#include "geometry/formats/mesh_builder.h"
#include "geometry/formats/read_assimp.h"
#include "geometry/formats/read_inventor.h"
#include "geometry/obj/read_obj.h"

namespace navvy::geometry {
namespace {

std::string ending_of(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending;
}

/// Returns the mesh of an OBJ file, which may have vertices alone, as `read_obj` reads it.
TriangleMesh read_faces(const std::string& path) {
  TriangleMesh mesh = read_obj(path);
  if (mesh.triangles.empty()) refuse_empty_mesh(path);
  return mesh;
}

}  // namespace

const std::vector<std::string>& mesh_endings() {
  static const std::vector<std::string> endings = {".obj", ".stl", ".dae", ".gltf",
                                                   ".glb", ".iv",  ".wrl", ".vrml"};
  return endings;
}

bool is_mesh_file(const std::string& path) {
  const auto& known = mesh_endings();
  return std::find(known.begin(), known.end(), ending_of(path)) != known.end();
}

TriangleMesh read_mesh(const std::string& path) {
  const std::string ending = ending_of(path);
#ifdef NAVVY_SLIM
  if (ending != ".obj")
    throw InputError(Fault{Fault::Severity::kError, path, 0, "mesh", ending,
                           "this build of Navvy reads OBJ files only",
                           "convert the file to OBJ, or install the full program"});
  return read_faces(path);
#else
  if (ending == ".iv" || ending == ".wrl" || ending == ".vrml") return read_inventor(path);
  if (ending == ".stl" || ending == ".dae" || ending == ".gltf" || ending == ".glb")
    return read_assimp(path);
  return read_faces(path);
#endif
}

}  // namespace navvy::geometry
