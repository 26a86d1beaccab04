// SPDX-License-Identifier: Apache-2.0
#include "record/run_info.h"

#include <unistd.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string_view>

#include "core/error.h"
#include "core/file.h"

namespace navvy::record {

using nlohmann::json;

// The version is compiled in here only, for all clients.
std::string navvy_version() { return NAVVY_VERSION; }

std::map<std::string, std::string> deciding_environment() {
  static constexpr std::string_view kSearchPaths[] = {
      "GZ_SIM_RESOURCE_PATH", "IGN_GAZEBO_RESOURCE_PATH", "GAZEBO_MODEL_PATH", "ROS_PACKAGE_PATH",
      "AMENT_PREFIX_PATH"};
  std::map<std::string, std::string> out;
  for (char** each = environ; each != nullptr && *each != nullptr; ++each) {
    const std::string_view entry = *each;
    const std::string name(entry.substr(0, entry.find('=')));
    const auto begins = [&](const char* prefix) { return name.rfind(prefix, 0) == 0; };
    const bool decides =
        begins("NAVVY_") || begins("POCL_") || begins("OCL_ICD_") ||
        std::find(std::begin(kSearchPaths), std::end(kSearchPaths), name) != std::end(kSearchPaths);
    if (!decides || name == "POCL_CACHE_DIR" || name.size() == entry.size()) continue;
    out[name] = entry.substr(name.size() + 1);
  }
  return out;
}

std::string run_json(const RunInfo& info) {
  json kernels = {{"hash", info.kernels.hash}, {"shipped", info.kernels.changed.empty()}};
  if (!info.kernels.folder.empty()) kernels["folder"] = info.kernels.folder;
  if (!info.kernels.changed.empty()) kernels["changed"] = info.kernels.changed;
  // Only what scene.sdf does not contain.
  const json out = {{"format", info.format},     {"navvy", info.version},
                    {"command", info.command},   {"scene", info.scene},
                    {"device", info.device},     {"kernels", kernels},
                    {"schedule", info.schedule}, {"environment", info.environment}};
  // Paths and device names may contain invalid UTF-8, which is replaced.
  return out.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

RunInfo read_run_info(const std::string& folder) {
  const std::string path = folder + "/run.json";
  const std::vector<char> bytes = read_file(path);
  const json in = json::parse(bytes.begin(), bytes.end(), nullptr, false);
  const auto refuse = [&](const std::string& value, const std::string& rule,
                          const std::string& remedy) {
    throw InputError(Fault{Fault::Severity::kError, path, 0, "format", value, rule, remedy});
  };
  // A file without a format is no run.json.
  if (!in.is_object() || !in.contains("format") || !in["format"].is_number_integer())
    refuse("", "the file must be the run.json of a run's folder",
           "name a folder that `navvy run` wrote");
  RunInfo info;
  info.format = in["format"].get<int>();
  if (info.format > kRunFormat)
    refuse(std::to_string(info.format),
           "this version reads folders up to format " + std::to_string(kRunFormat),
           "use the version of Navvy that wrote it");
  // Keys that an older format lacks stay empty.
  info.version = in.value("navvy", "");
  info.command = in.value("command", std::vector<std::string>());
  info.scene = in.value("scene", "");
  info.device = in.value("device", "");
  const json kernels = in.value("kernels", json::object());
  info.kernels.hash = kernels.value("hash", "");
  info.kernels.folder = kernels.value("folder", "");
  info.kernels.changed = kernels.value("changed", std::vector<std::string>());
  info.schedule = in.value("schedule", "");
  info.environment = in.value("environment", info.environment);
  return info;
}

}  // namespace navvy::record
