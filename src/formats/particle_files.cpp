// SPDX-License-Identifier: Apache-2.0
// The list of formats for particles. A new format is a file of its own and two lines here.
#include "formats/particle_files.h"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/edit_distance.h"
#include "core/error.h"

namespace navvy::formats {

// Each is defined in the file of its format.
ParticleFormat particle_npz_format();
ParticleFormat particle_vtu_format();
ParticleFormat particle_ply_format();

const std::vector<ParticleFormat>& particle_formats() {
  static const std::vector<ParticleFormat> table = {particle_npz_format(), particle_vtu_format(),
                                                    particle_ply_format()};
  return table;
}

const ParticleFormat& particle_format_named(const std::string& name) {
  std::vector<std::string> names;
  for (const ParticleFormat& each : particle_formats()) {
    if (each.name == name) return each;
    names.push_back(each.name);
  }
  throw InputError(Fault{Fault::Severity::kError, "", 0, "particles", name,
                         "is not a format of particles; expected " + particle_format_names(),
                         suggestion(name, names)});
}

const ParticleFormat& particle_format_of(const std::string& path, const std::string& option) {
  const std::string extension = std::filesystem::path(path).extension().string();
  std::string known;
  for (const ParticleFormat& each : particle_formats()) {
    if (each.extension == extension) return each;
    known += (known.empty() ? "" : ", ") + each.extension;
  }
  throw InputError(Fault{Fault::Severity::kError, "", 0, option, path,
                         "has none of the endings " + known + ", which name the format",
                         "name the file, for example, particles.npz"});
}

std::string particle_format_names() {
  const std::vector<ParticleFormat>& all = particle_formats();
  std::string out;
  for (std::size_t i = 0; i < all.size(); ++i)
    out += (i == 0 ? "" : i + 1 == all.size() ? " or " : ", ") + all[i].name;
  return out;
}

std::string particle_header(const scene::ParticleTable& particles) {
  nlohmann::ordered_json arrays = nlohmann::ordered_json::object();
  for (const scene::ParticleArray& one : particles.arrays())
    arrays[one.name] = {
        {"type", scene::name_of(one.type)}, {"unit", one.unit}, {"meaning", one.meaning}};
  nlohmann::ordered_json soils = nlohmann::ordered_json::array();
  for (const scene::ParticleSoil& soil : particles.soils)
    soils.push_back({{"name", soil.name}, {"bank_density_kg_m3", soil.bank_density}});
  const nlohmann::ordered_json out = {{"format_version", 1},      {"count", particles.count()},
                                      {"time_s", particles.time}, {"steps", particles.steps},
                                      {"soils", soils},           {"arrays", arrays}};
  // Bytes that are not UTF-8 stand as U+FFFD: a soil's name must not stop the export.
  return out.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace navvy::formats
