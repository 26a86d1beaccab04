// SPDX-License-Identifier: Apache-2.0
#include "scene_io/shipped.h"

#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>

#include "core/edit_distance.h"
#include "core/error.h"
#include "scene_io/loader.h"

namespace navvy::scene_io {

namespace fs = std::filesystem;

std::map<std::string, std::string> shipped_machines() {
  std::map<std::string, std::string> files;
  std::error_code ignored;
  for (const std::string& directory : data_directories())
    // A directory that does not exist yields an empty range, as errors are ignored.
    for (const auto& entry : fs::directory_iterator(directory + "/vehicles", ignored)) {
      const std::string model = (entry.path() / "model.sdf").string();
      // `emplace` keeps the first path of a name, which is that of the first data directory.
      if (fs::exists(model, ignored)) files.emplace(entry.path().filename().string(), model);
    }
  return files;
}

std::map<std::string, std::string> shipped_scenes() {
  std::map<std::string, std::string> out;
  std::error_code ignored;
  for (const std::string& directory : data_directories()) {
    const fs::path scenarios = fs::path(directory) / "scenarios";
    for (const auto& entry : fs::recursive_directory_iterator(scenarios, ignored)) {
      // Other files, such as maps, are beside the scenes.
      if (entry.path().extension() != ".sdf") continue;
      const fs::path name = entry.path().lexically_relative(scenarios);
      out.emplace(fs::path(name).replace_extension().generic_string(), entry.path().string());
    }
  }
  return out;
}

std::string find_scene(const std::string& name) {
  // A loop of links, or a folder that may not be entered, is reported by the reader of the file.
  std::error_code unreadable;
  if (fs::exists(name, unreadable) || unreadable) return name;
  // The longer forms let a user write names as `navvy scenes` prints them.
  for (const std::string& candidate : {name, "scenarios/" + name, "scenarios/" + name + ".sdf"})
    if (const std::string found = find_data(candidate); !found.empty()) return found;
  if (name.find('/') != std::string::npos) return name;
  std::vector<std::string> known;
  for (const auto& [scene, path] : shipped_scenes()) known.push_back(scene);
  throw InputError(Fault{Fault::Severity::kError, "", 0, "scene", name,
                         "no such file here and no such shipped scene",
                         known.empty() ? "set NAVVY_DATA_DIR"
                                       : suggestion(name, known) + "; `navvy scenes` lists them"});
}

std::string find_machine(const std::string& name, const std::string& where) {
  std::error_code unreadable;
  if (fs::is_regular_file(name, unreadable)) return name;
  std::vector<std::string> known;
  for (const auto& [machine, path] : shipped_machines()) {
    if (machine == name) return path;
    known.push_back(machine);
  }
  throw InputError(Fault{
      Fault::Severity::kError, "", 0, where, name, "no such file here and no such shipped machine",
      known.empty() ? "set NAVVY_DATA_DIR"
                    : suggestion(name, known) + "; `navvy machines` lists them"});
}

std::vector<scene::Soil> shipped_soils() {
  const std::string directory = find_data("terrain/soils");
  if (directory.empty())
    throw InputError(Fault{
        Fault::Severity::kError, "terrain/soils", 0, "", "", "the shipped soils were not found",
        "set NAVVY_DATA_DIR to the directory that holds terrain/ and vehicles/"});
  return load_soils(directory);
}

scene::Soil shipped_soil(const std::string& name, const std::string& where) {
  std::vector<std::string> names;
  for (const scene::Soil& soil : shipped_soils()) {
    if (soil.name == name) return soil;
    names.push_back(soil.name);
  }
  throw InputError(Fault{Fault::Severity::kError, "", 0, where, name, "no such shipped soil",
                         suggestion(name, names) + "; `navvy soils` lists them"});
}

std::string description_of(const std::string& file) {
  std::ifstream in(file);
  // The description is near the top by convention; whole files would be read for every listing.
  std::string text(4096, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  for (std::size_t at = text.find("<!--"); at != std::string::npos;
       at = text.find("<!--", at + 4)) {
    const std::size_t end = text.find("-->", at);
    if (end == std::string::npos) break;
    const std::string comment = text.substr(at + 4, end - at - 4);
    if (comment.find("SPDX") != std::string::npos) continue;
    // Spaces and line ends become single spaces.
    std::istringstream words(comment);
    std::string out;
    for (std::string word; words >> word;) out += (out.empty() ? "" : " ") + word;
    return out;
  }
  return "";
}

}  // namespace navvy::scene_io
