// SPDX-License-Identifier: Apache-2.0
#include "geometry/obj/read_obj.h"

#include <tiny_obj_loader.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <string_view>

#include "core/error.h"
#include "core/file.h"
#include "core/log.h"

namespace navvy::geometry {
namespace {

constexpr std::uintmax_t kMostBytes = std::uintmax_t{64} << 20;

/// Line 0: the fault is not in one line.
[[noreturn]] void refuse(const std::string& path, int line, std::string_view value, const std::string& rule) {
  throw InputError(Fault{Fault::Severity::kError, path, line, "", std::string(value), rule, "export the mesh again"});
}

/// The next word of a line, taken off it; empty at the end.
std::string_view next_word(std::string_view& line) {
  constexpr std::string_view kBlank = " \t";
  line.remove_prefix(std::min(line.find_first_not_of(kBlank), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(kBlank));
  line.remove_prefix(word.size());
  return word;
}

/// The library takes words it cannot read for zeros and keeps no line numbers, so what must not pass is looked for
/// before it reads: broken numbers and indices of vertices.
class LineCheck {
 public:
  LineCheck(const std::string& path, std::string_view text) : path_(path) {
    // Faces may name vertices that come later in the file, so those are counted first.
    each_line(text, [this](std::string_view line) { vertices_ += next_word(line) == "v"; });
    each_line(text, [this](std::string_view line) {
      ++line_;
      std::string_view rest = line;
      const std::string_view key = next_word(rest);
      if (key == "v") vertex(line, rest);
      if (key == "f") face(line, rest);
    });
  }

 private:
  template <class Work>
  static void each_line(std::string_view text, const Work& work) {
    while (!text.empty()) {
      const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
      work(text.substr(0, end));
      // Lines end in \n, \r\n or \r, as the library takes them.
      const std::size_t mark = text.substr(end, 2) == "\r\n" ? 2 : 1;
      text.remove_prefix(std::min(end + mark, text.size()));
    }
  }

  void vertex(std::string_view line, std::string_view rest) {
    ++seen_;
    for (int k = 0; k < 3; ++k) {
      std::string_view word = next_word(rest);
      // The library takes a plus sign, from_chars does not.
      if (!word.empty() && word.front() == '+') word.remove_prefix(1);
      double value = 0;
      const auto [end, failed] = std::from_chars(word.data(), word.data() + word.size(), value);
      // Vertices are kept in single precision: 1e39 is as infinite as inf.
      if (failed != std::errc() || end != word.data() + word.size() || !std::isfinite(static_cast<float>(value)))
        refuse(path_, line_, line, "a vertex must be three finite numbers");
    }
  }

  void face(std::string_view line, std::string_view rest) {
    int corners = 0;
    for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest), ++corners) {
      // vertex/texture/normal: the vertex counts from 1, or backwards from the last one read.
      long index = 0;
      const auto [end, failed] = std::from_chars(word.data(), word.data() + word.size(), index);
      const bool whole = failed == std::errc() && (end == word.data() + word.size() || *end == '/');
      if (!whole || index == 0 || index > vertices_ || index < -seen_)
        refuse(path_, line_, line, "a face must name vertices from 1 to " + std::to_string(vertices_));
    }
    if (corners < 3) refuse(path_, line_, line, "a face must have at least three corners");
  }

  const std::string& path_;
  long vertices_ = 0, seen_ = 0;  // in the file, so far
  int line_ = 0;
};

/// Ambient light, textures and the like are left out: pictures do without.
MeshMaterial to_material(const tinyobj::material_t& m) {
  return {m.name,
          {m.diffuse[0], m.diffuse[1], m.diffuse[2]},
          {m.specular[0], m.specular[1], m.specular[2]},
          m.shininess,
          m.dissolve};
}

}  // namespace

TriangleMesh read_obj(const std::string& path) {
  // Before it is in memory. A file that cannot be asked for its size tells why when it is read.
  std::error_code unknown;
  const std::uintmax_t size = std::filesystem::file_size(path, unknown);
  if (!unknown && size > kMostBytes) refuse(path, 0, std::to_string(size), "an OBJ file may have at most 64 MB");
  const std::vector<char> bytes = read_file(path);
  const std::string text(bytes.begin(), bytes.end());
  const LineCheck check(path, text);

  // MTL files are named relative to the OBJ file.
  tinyobj::attrib_t attributes;
  std::vector<tinyobj::shape_t> shapes;
  std::vector<tinyobj::material_t> materials;
  std::string warning, error;
  std::istringstream stream(text);
  tinyobj::MaterialFileReader beside(std::filesystem::path(path).parent_path().string());
  const bool read = tinyobj::LoadObj(&attributes, &shapes, &materials, &warning, &error, &stream, &beside, true);
  if (!read) refuse(path, 0, "", "cannot be read as an OBJ file: " + error);
  // A missing MTL file changes colours only.
  if (!warning.empty()) log_warning(path + ": " + warning);

  // Indices into the vertices stay the file's own: vertices are not split by normals or materials.
  TriangleMesh mesh;
  const std::vector<tinyobj::real_t>& v = attributes.vertices;
  for (std::size_t i = 0; i + 2 < v.size(); i += 3) mesh.vertices.emplace_back(v[i], v[i + 1], v[i + 2]);
  for (const tinyobj::material_t& material : materials) mesh.materials.push_back(to_material(material));
  for (const tinyobj::shape_t& shape : shapes)
    for (std::size_t f = 0; f < shape.mesh.num_face_vertices.size(); ++f) {
      const tinyobj::index_t* corner = &shape.mesh.indices[3 * f];
      mesh.triangles.push_back({corner[0].vertex_index, corner[1].vertex_index, corner[2].vertex_index});
      if (!materials.empty()) mesh.material_of.push_back(std::max(-1, shape.mesh.material_ids[f]));
    }
  require_valid(mesh, path);
  return mesh;
}

}  // namespace navvy::geometry
