// SPDX-License-Identifier: Apache-2.0
// A folder private to one test: ctest runs the tests of one program in parallel.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

namespace navvy::test {

/// Creates an empty folder that is removed at the end.
class Folder {
 public:
  Folder()
      : path_(std::filesystem::path(::testing::TempDir()) /
              ("navvy_" + std::to_string(::getpid()) + "_" + name())) {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// Path of a file in it.
  std::string operator/(const std::string& file) const { return (path_ / file).string(); }

 private:
  static std::string name() {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    std::string out = std::string(info->test_suite_name()) + "_" + info->name();
    for (char& c : out)
      if (c == '/') c = '_';
    return out;
  }
  std::filesystem::path path_;
};

}  // namespace navvy::test
