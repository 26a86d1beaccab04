// SPDX-License-Identifier: Apache-2.0
#include "heightfield/map_files/beside.h"

#include <algorithm>
#include <filesystem>

#include "core/error.h"
#include "core/file.h"
#include "core/limits.h"
#include "heightfield/map_files/ascii_words.h"

namespace navvy::heightfield {
namespace {

namespace fs = std::filesystem;

}  // namespace

std::vector<std::string> files_beside(const std::string& file) {
  const fs::path path = file;
  std::vector<std::string> known = {lower_case(path.filename().string() + ".aux.xml")};
  for (const char* ending :
       {".prj", ".tfw", ".tifw", ".tiffw", ".pgw", ".pngw", ".wld", ".aux.xml"})
    known.push_back(lower_case(path.stem().string() + ending));
  std::vector<std::string> names = {path.filename().string()};
  std::error_code failed;
  // Some programs write endings and names in capitals, and GDAL looks for those too.
  for (fs::directory_iterator at(path.parent_path().empty() ? "." : path.parent_path(), failed),
       end;
       !failed && at != end; at.increment(failed)) {
    const std::string name = at->path().filename().string();
    if (std::find(known.begin(), known.end(), lower_case(name)) == known.end()) continue;
    require_regular(at->path().string());
    std::error_code unknown;
    const std::uintmax_t size = fs::file_size(at->path(), unknown);
    if (!unknown && size > limits::kMapSidecarBytes)
      throw FileError("cannot read '" + at->path().string() + "': it has " + std::to_string(size) +
                      " bytes, a file beside a map may have " +
                      std::to_string(limits::kMapSidecarBytes));
    names.push_back(name);
  }
  std::sort(names.begin() + 1, names.end());
  return names;
}

}  // namespace navvy::heightfield
