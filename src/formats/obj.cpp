// SPDX-License-Identifier: Apache-2.0
// Wavefront OBJ: the vertices are the centres of known columns, row by row from least y. The format
// cannot hold layers.
#include <charconv>
#include <cstdint>

#include "core/error.h"
#include "core/file.h"
#include "formats/formats.h"

namespace navvy::formats {
namespace {

/// Appends the shortest text that reads back to the same number.
template <class T>
void append(std::string& to, T value) {
  char text[32];
  to.append(text, std::to_chars(text, text + sizeof text, value).ptr);
}

// Text in one pass: an unknown column has no vertex, and faces only join known ones.
void write_obj(const map::TerrainMap& map, const std::vector<map::MapLayer>& layers,
               const std::string& path) {
  if (layers.size() != 1 || !map::info(layers[0]).height())
    throw InputError(Fault{Fault::Severity::kError, path, 0, "obj",
                           layers.empty() ? "" : map::info(layers.back()).name,
                           "a mesh is one surface: elevation, elevation_start or target",
                           "ask for ply to have layers"});
  const int nx = map.nx(), ny = map.ny();
  const std::vector<float> z = map.copy(layers[0]);
  std::string text = "# metres in the world's frame, z up\no " + map::info(layers[0]).name + "\n";
  std::vector<std::int32_t> vertex(z.size(), 0);
  std::int32_t count = 0;
  for (int iy = 0, i = 0; iy < ny; ++iy)
    for (int ix = 0; ix < nx; ++ix, ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (z[k] != z[k]) continue;
      // OBJ numbers vertices from 1.
      vertex[k] = ++count;
      text += "v ";
      append(text, map.origin().x() + map.cell() * (ix + 0.5));
      text += ' ';
      append(text, map.origin().y() + map.cell() * (iy + 0.5));
      text += ' ';
      append(text, z[k]);
      text += '\n';
    }
  const auto triangle = [&](std::size_t a, std::size_t b, std::size_t c) {
    if (vertex[a] == 0 || vertex[b] == 0 || vertex[c] == 0) return;
    text += 'f';
    for (const std::size_t k : {a, b, c}) {
      text += ' ';
      append(text, vertex[k]);
    }
    text += '\n';
  };
  // Faces are counter-clockwise from above, as in the PLY.
  for (int iy = 0; iy + 1 < ny; ++iy)
    for (int ix = 0; ix + 1 < nx; ++ix) {
      const auto k = static_cast<std::size_t>(iy) * static_cast<std::size_t>(nx) +
                     static_cast<std::size_t>(ix);
      const auto up = k + static_cast<std::size_t>(nx);
      triangle(k, k + 1, up + 1);
      triangle(k, up + 1, up);
    }
  write_file_atomically(path, text);
}

}  // namespace

MapFormat obj_format() {
  return {.name = "obj",
          .extension = ".obj",
          .meaning = "triangles of one surface",
          .by_default = {map::MapLayer::kElevation},
          .write = write_obj};
}

}  // namespace navvy::formats
