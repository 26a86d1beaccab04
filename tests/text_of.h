// SPDX-License-Identifier: Apache-2.0
// Reads a file in a test.
#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace navvy::test {

/// Returns all bytes of a file; empty if it does not exist.
inline std::string text_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::stringstream out;
  out << in.rdbuf();
  return out.str();
}

}  // namespace navvy::test
