// SPDX-License-Identifier: Apache-2.0
// Binary little-endian PLY: the vertices are the centres of known columns, row by row from least y.
#include <cstdint>
#include <cstring>

#include "core/error.h"
#include "core/file.h"
#include "formats/formats.h"

namespace navvy::formats {
namespace {

/// Appends the bytes of a number, little-endian.
template <class T>
void put(std::vector<char>& to, T value) {
  char bytes[sizeof(T)];
  std::memcpy(bytes, &value, sizeof value);
  to.insert(to.end(), bytes, bytes + sizeof value);
}

// Vertices and faces are collected apart, because the header needs both counts.
void write_ply(const map::TerrainMap& map, const std::vector<map::MapLayer>& layers,
               const std::string& path) {
  const int nx = map.nx(), ny = map.ny();
  if (map.rect().area() > 100'000'000)
    throw InputError(Fault{Fault::Severity::kError, path, 0, "ply",
                           std::to_string(map.rect().area()) + " columns", "at most 10^8",
                           "ask for a GeoTIFF"});
  // Dense copies suffice: the whole file is built in memory before it is written.
  const std::vector<float> z = map.copy(map::MapLayer::kElevation);
  std::vector<std::vector<float>> values;
  for (const map::MapLayer layer : layers) values.push_back(map.copy(layer));
  // Number of each vertex, -1 where the surface is unknown.
  std::vector<std::int32_t> vertex(z.size(), -1);
  std::vector<char> vertices, faces;
  std::int32_t count = 0, triangles = 0;
  for (int iy = 0, i = 0; iy < ny; ++iy)
    for (int ix = 0; ix < nx; ++ix, ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (z[k] != z[k]) continue;
      vertex[k] = count++;
      // Doubles, because a site may be far from the origin of W.
      put(vertices, map.origin().x() + map.cell() * (ix + 0.5));
      put(vertices, map.origin().y() + map.cell() * (iy + 0.5));
      put(vertices, static_cast<double>(z[k]));
      for (const std::vector<float>& layer : values) put(vertices, layer[k]);
    }
  const auto triangle = [&](std::int32_t a, std::int32_t b, std::int32_t c) {
    if (a < 0 || b < 0 || c < 0) return;
    put(faces, std::uint8_t{3});
    for (const std::int32_t corner : {a, b, c}) put(faces, corner);
    ++triangles;
  };
  // Faces are counter-clockwise from above; the diagonal runs from least to greatest x and y.
  for (int iy = 0; iy + 1 < ny; ++iy)
    for (int ix = 0; ix + 1 < nx; ++ix) {
      const auto k = static_cast<std::size_t>(iy) * static_cast<std::size_t>(nx) +
                     static_cast<std::size_t>(ix);
      const auto up = k + static_cast<std::size_t>(nx);
      triangle(vertex[k], vertex[k + 1], vertex[up + 1]);
      triangle(vertex[k], vertex[up + 1], vertex[up]);
    }
  // The header comes first in the file, but needs the counts.
  std::string head =
      "ply\nformat binary_little_endian 1.0\ncomment metres in the world's frame, z up\nelement "
      "vertex " +
      std::to_string(count) + "\nproperty double x\nproperty double y\nproperty double z\n";
  for (const map::MapLayer layer : layers) head += "property float " + map::info(layer).name + "\n";
  head += "element face " + std::to_string(triangles) +
          "\nproperty list uchar int vertex_indices\nend_header\n";
  std::vector<char> bytes(head.begin(), head.end());
  bytes.insert(bytes.end(), vertices.begin(), vertices.end());
  bytes.insert(bytes.end(), faces.begin(), faces.end());
  write_file_atomically(path, bytes);
}

}  // namespace

MapFormat ply_format() {
  return {.name = "ply",
          .extension = ".ply",
          .meaning = "triangles with layers at the vertices",
          .by_default = {map::MapLayer::kElevation},
          .write = write_ply};
}

}  // namespace navvy::formats
