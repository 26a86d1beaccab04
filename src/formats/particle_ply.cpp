// SPDX-License-Identifier: Apache-2.0
// Particles as binary little-endian PLY: a vertex per particle, a property per element.
#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/printable.h"
#include "formats/part_file.h"
#include "formats/particle_files.h"

namespace navvy::formats {
namespace {

/// Bytes of vertices that are written at once.
constexpr std::size_t kPiece = std::size_t{1} << 20;

const char* type_of(scene::ParticleElement type) {
  switch (type) {
    case scene::ParticleElement::kUint16:
      return "ushort";
    case scene::ParticleElement::kUint32:
      return "uint";
    case scene::ParticleElement::kFloat32:
      return "float";
    case scene::ParticleElement::kFloat64:
      break;
  }
  return "double";
}

/// Returns the header: comments with time, units and soils, and the properties.
std::string header(const scene::ParticleTable& particles,
                   const std::vector<scene::ParticleArray>& arrays) {
  const auto number = [](double value) { return nlohmann::json(value).dump(); };
  std::string out =
      "ply\nformat binary_little_endian 1.0\ncomment particles of Navvy, in the world's frame, z "
      "up\ncomment time_s " +
      number(particles.time) + "\ncomment steps " + std::to_string(particles.steps) + "\n";
  for (std::size_t i = 0; i < particles.soils.size(); ++i)
    out += "comment soil " + std::to_string(i) + " bank_density_kg_m3 " +
           number(particles.soils[i].bank_density) + " name " + printable(particles.soils[i].name) +
           "\n";
  for (const scene::ParticleArray& one : arrays)
    out += "comment unit " + one.name + " " + one.unit + "\n";
  out += "element vertex " + std::to_string(particles.count()) + "\n";
  for (const scene::ParticleArray& one : arrays) {
    const std::string property = std::string("property ") + type_of(one.type) + " ";
    if (one.components.empty()) out += property + one.name + "\n";
    // Readers look for a position by the names x, y and z.
    for (const std::string& component : one.components)
      out += property + (one.name == "position" ? "" : one.name + "_") + component + "\n";
  }
  return out + "end_header\n";
}

void write_ply(const scene::ParticleTable& particles, const std::string& path) {
  const std::vector<scene::ParticleArray> arrays = particles.arrays();
  PartFile file(path);
  const std::string head = header(particles, arrays);
  file.write(head.data(), head.size());
  // Vertex by vertex: the format has no arrays.
  std::vector<std::byte> waiting;
  const auto flush = [&] {
    if (!waiting.empty()) file.write(waiting.data(), waiting.size());
    waiting.clear();
  };
  for (std::size_t i = 0; i < particles.count(); ++i) {
    for (const scene::ParticleArray& one : arrays) {
      const auto value = one.bytes.subspan(i * one.stride(), one.stride());
      waiting.insert(waiting.end(), value.begin(), value.end());
    }
    if (waiting.size() >= kPiece) flush();
  }
  flush();
  file.commit();
}

}  // namespace

ParticleFormat particle_ply_format() {
  return {"ply", ".ply", "points with properties, binary little-endian", write_ply};
}

}  // namespace navvy::formats
