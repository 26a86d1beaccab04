// SPDX-License-Identifier: Apache-2.0
// `navvy` as a process: a folder per test, the program run in it, and its output.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "paths.h"
#include "process.h"
#include "text_of.h"

namespace navvy::test {

/// Runs the program in a folder of the test, which remains after the test for inspection.
class ProgramRun : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    directory_ =
        std::filesystem::path(build_dir()) / "test-cli" / info->test_suite_name() / info->name();
    std::filesystem::remove_all(directory_);
    std::filesystem::create_directories(directory_);
  }

  /// Starts navvy with `input` as its standard input; both outputs go to files.
  pid_t start(const std::vector<std::string>& arguments, const std::string& input = "") {
    const std::string in = (directory_ / "stdin").string();
    std::ofstream(in) << input;
    return test::start({NAVVY_PROGRAM, arguments, environment_, in,
                        (directory_ / "stdout").string(), (directory_ / "stderr").string()});
  }
  /// Runs navvy and returns its exit status, or minus the signal that ended it.
  int run(const std::vector<std::string>& arguments, const std::string& input = "") {
    return wait_for(start(arguments, input));
  }
  std::string out() const { return (directory_ / "out").string(); }
  std::string said() const { return text_of(directory_ / "stdout"); }
  std::string complained() const { return text_of(directory_ / "stderr"); }
  void expect_complained(const std::string& part) const {
    EXPECT_NE(complained().find(part), std::string::npos) << "'" << part << "' is not in:\n"
                                                          << complained();
  }
  /// Returns the path of a file in the folder of the test.
  std::string path(const std::string& name) const { return (directory_ / name).string(); }
  nlohmann::json summary() const {
    return nlohmann::json::parse(text_of(out() + "/summary.json"), nullptr, false);
  }

  std::filesystem::path directory_;
  /// Environment of the program, added to that of the test.
  std::vector<std::pair<std::string, std::string>> environment_;
};

}  // namespace navvy::test
