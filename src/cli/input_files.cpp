// SPDX-License-Identifier: Apache-2.0
#include "cli/input_files.h"

#include <filesystem>

#include "core/error.h"
#include "core/file.h"

namespace navvy::cli {

std::string scene_in(const std::string& folder, const std::string& command,
                     const std::string& asked) {
  const std::string file = (std::filesystem::path(folder) / "scene.sdf").string();
  std::error_code unreadable;
  if (std::filesystem::is_regular_file(file, unreadable)) return file;
  throw InputError(Fault{Fault::Severity::kError, "", 0, command, asked,
                         "there is no scene.sdf in '" + (folder.empty() ? "." : folder) + "'",
                         "give a snapshot's scene with --scene FILE, or a folder of a run"});
}

void require_apart(const std::string& named, const std::vector<std::string>& outputs,
                   const std::vector<std::string>& reads) {
  for (const std::string& to : outputs)
    for (const std::string& read : reads)
      if (same_file(to, read))
        throw InputError(Fault{Fault::Severity::kError, "", 0, "--out", named,
                               "would replace '" + read + "', which it is made from",
                               "name another file"});
}

}  // namespace navvy::cli
