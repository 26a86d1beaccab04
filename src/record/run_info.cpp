// SPDX-License-Identifier: Apache-2.0
#include "record/run_info.h"

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/file.h"

namespace navvy::record {

using nlohmann::json;

// The version is compiled in here only, for all clients.
std::string navvy_version() { return NAVVY_VERSION; }

std::string run_json(const RunInfo& info) {
  // Only what scene.sdf does not contain.
  const json out = {{"format", info.format},
                    {"navvy", info.version},
                    {"command", info.command},
                    {"scene", info.scene},
                    {"device", info.device}};
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
  return info;
}

}  // namespace navvy::record
