// SPDX-License-Identifier: Apache-2.0
// Particles as NumPy's NPZ: an array (n, ...) for each quantity and `header.json`
// (particle_header).
#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "formats/npy_file.h"
#include "formats/particle_files.h"
#include "formats/zip_archive.h"

namespace navvy::formats {
namespace {

/// Bytes of an array that are handed over at once.
constexpr std::size_t kPiece = std::size_t{1} << 20;

/// Returns an element type in NumPy's notation.
const char* descr_of(scene::ParticleElement type) {
  switch (type) {
    case scene::ParticleElement::kUint16:
      return "<u2";
    case scene::ParticleElement::kUint32:
      return "<u4";
    case scene::ParticleElement::kFloat32:
      return "<f4";
    case scene::ParticleElement::kFloat64:
      break;
  }
  return "<f8";
}

void write_npz(const scene::ParticleTable& particles, const std::string& path) {
  ZipArchive zip(path);
  // The header first: a reader of the stream knows what comes.
  zip.add("header.json", particle_header(particles));
  for (const scene::ParticleArray& array : particles.arrays()) {
    std::vector<std::uint64_t> shape = {particles.count()};
    for (const int length : array.shape) shape.push_back(static_cast<std::uint64_t>(length));
    const std::string head = npy_header(descr_of(array.type), shape);
    // The bytes belong to the table, which outlives the archive.
    zip.add(array.name + ".npy", head.size() + array.bytes.size(),
            [head, bytes = array.bytes, started = false]() mutable -> std::string {
              if (!std::exchange(started, true)) return head;
              const auto piece = bytes.first(std::min(kPiece, bytes.size()));
              bytes = bytes.subspan(piece.size());
              return {reinterpret_cast<const char*>(piece.data()), piece.size()};
            });
  }
  zip.commit();
}

}  // namespace

ParticleFormat particle_npz_format() {
  return {"npz", ".npz", "NumPy arrays and header.json", write_npz};
}

}  // namespace navvy::formats
