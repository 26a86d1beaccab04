// SPDX-License-Identifier: Apache-2.0
// Recognises log lines that already state their severity.
#pragma once

#include <string>

namespace navvy::cli {

/// Returns true if `line` states its severity, as the text of a Fault does: "error: ..." or
/// "file:line: warning: ...". The severity is then not added again.
inline bool has_severity(const std::string& line) {
  // Colons of the file part are not followed by a space.
  const std::size_t colon = line.find(": ");
  if (colon == std::string::npos) return false;
  for (const char* const word : {"warning", "error"})
    if (line.substr(0, colon) == word ||
        line.rfind(std::string(": ") + word + ": ", colon) == colon)
      return true;
  return false;
}

}  // namespace navvy::cli
