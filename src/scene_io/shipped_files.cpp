// SPDX-License-Identifier: Apache-2.0
#include "scene_io/shipped_files.h"

#include <algorithm>
#include <filesystem>

#include "scene_io/loader.h"

namespace navvy::scene_io {

namespace fs = std::filesystem;

std::vector<std::string> shipped_files(const std::string& folder) {
  std::vector<std::string> out;
  std::error_code ignored;
  for (const std::string& directory : data_directories())
    for (const auto& entry : fs::directory_iterator(fs::path(directory) / folder, ignored))
      if (entry.path().extension() == ".sdf") out.push_back(entry.path().stem().string());
  // A file in two directories is suggested once.
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

std::string data_file(const std::string& directory, const std::string& ref,
                      const std::string& folder) {
  if (fs::path(ref).extension() == ".sdf") return (fs::path(directory) / ref).string();
  // The shipped files are in no folders of their own.
  return ref.find('/') == std::string::npos ? find_data(folder + "/" + ref + ".sdf") : "";
}

}  // namespace navvy::scene_io
