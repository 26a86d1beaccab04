// SPDX-License-Identifier: Apache-2.0
#include "geometry/obj/read_obj.h"

#include <tiny_obj_loader.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "core/error.h"
#include "core/file.h"
#include "core/limits.h"
#include "core/log.h"
#include "geometry/obj/line_check.h"

namespace navvy::geometry {
namespace {

namespace fs = std::filesystem;

/// Opens MTL files. The author of the OBJ file chose their names, so they are opened only in its
/// folder and below, and only regular files of bounded size.
class MaterialsBeside final : public tinyobj::MaterialReader {
 public:
  explicit MaterialsBeside(const std::string& obj)
      : obj_(obj), folder_(fs::path(obj).parent_path()) {}

  bool operator()(const std::string& name, std::vector<tinyobj::material_t>* materials,
                  std::map<std::string, int>* map, std::string* warning,
                  std::string* error) override {
    const fs::path plain = fs::path(name).lexically_normal();
    if (plain.is_absolute() || (!plain.empty() && *plain.begin() == ".."))
      refuse_obj(obj_, 0, "mtllib " + name,
                 "a material file must lie in the folder of the OBJ file or below",
                 "copy it beside the OBJ file and name it without a path");
    const std::string path = (folder_ / plain).string();
    std::error_code unknown;
    if (!fs::exists(path, unknown)) {
      // Logged once and ignored, as it changes colours only.
      *warning += "no material file '" + path + "'\n";
      return false;
    }
    std::vector<char> bytes;
    try {
      bytes = read_file(path, limits::kMtlBytes);
    } catch (const FileError& failure) {
      refuse_obj(obj_, 0, "mtllib " + name, failure.what(),
                 "name a material file, or remove the line");
    }
    std::istringstream stream(std::string(bytes.begin(), bytes.end()));
    tinyobj::LoadMtl(map, materials, &stream, warning, error);
    return true;
  }

 private:
  const std::string& obj_;
  fs::path folder_;
};

/// Converts a material. Ambient light and textures are ignored, as pictures do not use them.
MeshMaterial to_material(const tinyobj::material_t& m) {
  return {m.name,
          {m.diffuse[0], m.diffuse[1], m.diffuse[2]},
          {m.specular[0], m.specular[1], m.specular[2]},
          m.shininess,
          m.dissolve};
}

/// Shortens warnings: one for every face would be as long as the file.
std::string first_of(const std::string& warnings) {
  constexpr std::size_t kMost = 500;
  return warnings.size() <= kMost ? warnings : warnings.substr(0, kMost) + " ...";
}

}  // namespace

TriangleMesh read_obj(const std::string& path) {
  std::string text;
  try {
    const std::vector<char> bytes = read_file(path, limits::kObjBytes);
    text.assign(bytes.begin(), bytes.end());
  } catch (const FileError& failure) {
    std::error_code unknown;
    if (!fs::exists(path, unknown)) throw;
    refuse_obj(path, 0, "", failure.what(), "name a mesh file of at most 64 MB");
  }
  check_obj_lines(path, text);

  // Names of MTL files are relative to the OBJ file.
  tinyobj::attrib_t attributes;
  std::vector<tinyobj::shape_t> shapes;
  std::vector<tinyobj::material_t> materials;
  std::string warning, error;
  std::istringstream stream(std::move(text));
  MaterialsBeside beside(path);
  const bool read =
      tinyobj::LoadObj(&attributes, &shapes, &materials, &warning, &error, &stream, &beside, true);
  if (!read) refuse_obj(path, 0, "", "cannot be read as an OBJ file: " + error);
  // A missing MTL file changes colours only.
  if (!warning.empty()) log_warning(path + ": " + first_of(warning));

  // Vertex indices are those of the file: vertices are not split by normals or materials.
  TriangleMesh mesh;
  const std::vector<tinyobj::real_t>& v = attributes.vertices;
  for (std::size_t i = 0; i + 2 < v.size(); i += 3)
    mesh.vertices.emplace_back(v[i], v[i + 1], v[i + 2]);
  for (const tinyobj::material_t& material : materials)
    mesh.materials.push_back(to_material(material));
  for (const tinyobj::shape_t& shape : shapes)
    for (std::size_t f = 0; f < shape.mesh.num_face_vertices.size(); ++f) {
      const tinyobj::index_t* corner = &shape.mesh.indices[3 * f];
      mesh.triangles.push_back(
          {corner[0].vertex_index, corner[1].vertex_index, corner[2].vertex_index});
      if (!materials.empty()) mesh.material_of.push_back(std::max(-1, shape.mesh.material_ids[f]));
    }
  require_valid(mesh, path);
  return mesh;
}

}  // namespace navvy::geometry
