// SPDX-License-Identifier: Apache-2.0
// A file as a test reads it.
#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace navvy::test {

/// All bytes of a file; empty when it is not there.
inline std::string text_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::stringstream out;
  out << in.rdbuf();
  return out.str();
}

}  // namespace navvy::test
