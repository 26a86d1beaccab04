// SPDX-License-Identifier: Apache-2.0
// Which lines of the log carry their severity already.
#pragma once

#include <string>

namespace navvy::cli {

/// Whether a line is a fault as core/error.h writes it, `file:line: warning: ...`: nothing is to be
/// put before that.
inline bool print_its_severity(const std::string& line) {
  // The file's part has no blank after its colons.
  const std::size_t colon = line.find(": ");
  if (colon == std::string::npos) return false;
  for (const char* const word : {"warning", "error"})
    if (line.substr(0, colon) == word ||
        line.rfind(std::string(": ") + word + ": ", colon) == colon)
      return true;
  return false;
}

}  // namespace navvy::cli
