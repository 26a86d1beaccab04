// SPDX-License-Identifier: Apache-2.0
#include "geometry/formats/read_assimp.h"

#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/DefaultIOSystem.h>
#include <algorithm>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <filesystem>

#include "core/error.h"
#include "geometry/formats/mesh_builder.h"
#include "geometry/formats/read_in_child.h"

namespace navvy::geometry {
namespace {

namespace fs = std::filesystem;

/// Opens files only in the folder of the mesh and below: the author of the mesh chose their names.
class FilesBeside final : public Assimp::DefaultIOSystem {
 public:
  explicit FilesBeside(const std::string& mesh)
      : folder_(fs::weakly_canonical(fs::absolute(mesh).parent_path()).string() + "/") {}

  bool Exists(const char* file) const override {
    return is_beside(file) && DefaultIOSystem::Exists(file);
  }
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    return is_beside(file) && mode[0] == 'r' ? DefaultIOSystem::Open(file, mode) : nullptr;
  }

 private:
  bool is_beside(const char* file) const {
    std::error_code failed;
    const fs::path path = fs::weakly_canonical(fs::absolute(file, failed), failed);
    return !failed && path.string().rfind(folder_, 0) == 0 && fs::is_regular_file(path, failed);
  }
  std::string folder_;
};

int lines_of(const std::string& text) {
  return 1 + static_cast<int>(std::count(text.begin(), text.end(), '\n'));
}

/// Reports a Collada or STL file that was cut off, which the library reports without a line, or
/// reads as far as it goes.
void check_whole(const std::string& path, const std::string& ending, const std::string& bytes) {
  if (ending == ".dae" && bytes.find("</COLLADA>") == std::string::npos)
    refuse_mesh(path, lines_of(bytes), "end of the file",
                "a Collada file must end with </COLLADA>; this one is not one, or was cut off",
                "copy or export it again");
  if (ending != ".stl") return;
  const std::size_t text = bytes.find_first_not_of(" \t\r\n");
  const bool solid = text != std::string::npos && bytes.compare(text, 5, "solid") == 0;
  if (solid && bytes.find("facet") != std::string::npos) {
    if (bytes.find("endsolid") == std::string::npos)
      refuse_mesh(path, lines_of(bytes), "end of the file", "an STL file must end with endsolid",
                  "copy or export it again");
    return;
  }
  // Binary files hold zeros; this is a text without facets.
  if (solid && bytes.find('\0') == std::string::npos) refuse_empty_mesh(path);
  // A binary file has a header of 80 bytes, the number of triangles, and 50 bytes for each.
  std::uint32_t count = 0;
  if (bytes.size() < 84)
    refuse_mesh(path, 0, std::to_string(bytes.size()) + " bytes",
                "a binary STL file has at least 84 bytes", "copy or export it again");
  std::memcpy(&count, bytes.data() + 80, 4);
  if (count == 0) refuse_empty_mesh(path);
  if (bytes.size() < 84 + std::uint64_t{50} * count)
    refuse_mesh(path, 0, std::to_string(bytes.size()) + " bytes",
                "its header announces " + std::to_string(count) + " triangles, which take " +
                    std::to_string(84 + std::uint64_t{50} * count) + " bytes",
                "copy or export it again");
}

/// Returns the material of a mesh; -1 for none.
int material_of(const aiScene& scene, const aiMesh& mesh, MeshBuilder& builder) {
  if (mesh.mMaterialIndex >= scene.mNumMaterials) return -1;
  const aiMaterial& from = *scene.mMaterials[mesh.mMaterialIndex];
  aiString name;
  from.Get(AI_MATKEY_NAME, name);
  aiColor4D diffuse, specular(0.12f, 0.12f, 0.12f, 1);
  // The library gives this one to faces without a material.
  if (std::strcmp(name.C_Str(), AI_DEFAULT_MATERIAL_NAME) == 0 ||
      from.Get(AI_MATKEY_COLOR_DIFFUSE, diffuse) != AI_SUCCESS)
    return -1;
  from.Get(AI_MATKEY_COLOR_SPECULAR, specular);
  float opacity = 1, shininess = 20;
  from.Get(AI_MATKEY_SHININESS, shininess);
  // Exporters of Collada disagree about what 0 means; an invisible machine is meant by none.
  if (from.Get(AI_MATKEY_OPACITY, opacity) != AI_SUCCESS || !(opacity > 0)) opacity = 1;
  const auto unit = [](float x) { return std::clamp(std::isfinite(x) ? x : 0.0f, 0.0f, 1.0f); };
  MeshMaterial out;
  out.name = name.C_Str();
  out.diffuse = {unit(diffuse.r), unit(diffuse.g), unit(diffuse.b)};
  out.specular = {unit(specular.r), unit(specular.g), unit(specular.b)};
  out.shininess = std::clamp(std::isfinite(shininess) ? shininess : 0.0f, 0.0f, 1000.0f);
  out.opacity = unit(opacity);
  return builder.add_material(out);
}

using Matrix = Eigen::Matrix4d;

Matrix matrix_of(const aiMatrix4x4& m) {
  Matrix out;
  out << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1, m.d2, m.d3,
      m.d4;
  return out;
}

void add_node(const aiScene& scene, const aiNode& node, const Matrix& above, bool colored,
              int depth, MeshBuilder& builder) {
  // The depth of real files is below ten.
  if (depth > 200) return;
  const Matrix X = above * matrix_of(node.mTransformation);
  // A mirrored part has its corners in the other order.
  const bool mirrored = X.topLeftCorner<3, 3>().determinant() < 0;
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    const aiMesh& mesh = *scene.mMeshes[node.mMeshes[i]];
    const int material = colored ? material_of(scene, mesh, builder) : -1;
    const auto place = [&](unsigned v) {
      const aiVector3D& p = mesh.mVertices[v];
      return Vec3((X * Eigen::Vector4d(p.x, p.y, p.z, 1)).head<3>());
    };
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      // Points and lines have no area.
      if (face.mNumIndices != 3) continue;
      const Vec3 a = place(face.mIndices[0]), b = place(face.mIndices[1]),
                 c = place(face.mIndices[2]);
      builder.add(a, mirrored ? c : b, mirrored ? b : c, material);
    }
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i)
    add_node(scene, *node.mChildren[i], X, colored, depth + 1, builder);
}

TriangleMesh import(const std::string& path, const std::string& ending) {
  Assimp::Importer importer;
  // The importer owns the handler.
  importer.SetIOHandler(new FilesBeside(path));
  // Meshes of robots are meant in the axes of the file, whatever it calls up.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  // Of a file without faces the library would make up some that show the nodes.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
  const aiScene* scene = importer.ReadFile(path, aiProcess_Triangulate);
  if (scene == nullptr && std::strstr(importer.GetErrorString(), "has no faces") != nullptr)
    refuse_empty_mesh(path);
  if (scene == nullptr || scene->mRootNode == nullptr)
    refuse_mesh(path, 0, "", std::string("cannot be read: ") + importer.GetErrorString());
  Matrix turn = Matrix::Identity();
  if (ending == ".gltf" || ending == ".glb")
    turn << 1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1;
  MeshBuilder builder(path);
  // STL has no materials; the library makes one up.
  add_node(*scene, *scene->mRootNode, turn, ending != ".stl", 0, builder);
  return builder.finish();
}

}  // namespace

TriangleMesh read_assimp(const std::string& path) {
  std::string ending = fs::path(path).extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  check_whole(path, ending, mesh_bytes(path));
  // Release 5.2 crashes on some Collada files whose arrays have no `count`.
  return read_in_child(path, "Assimp", [&] { return import(path, ending); });
}

}  // namespace navvy::geometry
