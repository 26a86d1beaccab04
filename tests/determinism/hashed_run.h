// SPDX-License-Identifier: Apache-2.0
// Runs `navvy run --hash-every` in a separate process with its own environment, and compares two
// such runs.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "paths.h"
#include "process.h"
#include "text_of.h"

namespace navvy::determinism {

using Environment = std::vector<std::pair<std::string, std::string>>;

/// Environment of PoCL's workers: the older name of the variable (to 3.x) and the newer one (from
/// 4.0). Without the driver for the caller's thread, which would run small scenes in any case.
inline Environment threads(int count) {
  const std::string n = std::to_string(count);
  return {{"POCL_MAX_PTHREAD_COUNT", n}, {"POCL_CPU_MAX_CU_COUNT", n}, {"POCL_DEVICES", "pthread"}};
}

/// Environment for AVX2 kernels: PoCL compiles for the named processor, so a machine with AVX-512
/// can run both.
inline Environment avx2() {
  return {{"POCL_LLVM_CPU_NAME", "haswell"}, {"POCL_KERNELLIB_NAME", "avx2"}};
}

using test::text_of;

/// Output of a run.
struct HashedRun {
  int status = -1;
  std::string device;  ///< the line in which navvy names it
  /// Header of hashes.csv.
  std::string header;
  std::map<std::uint64_t, std::string> at;  ///< row by step
  nlohmann::json summary;
};

/// Folder of the run of this name, below the build tree.
inline std::filesystem::path run_folder(const std::string& name) {
  return std::filesystem::path(navvy::build_dir()) / "test-determinism" /
         testing::UnitTest::GetInstance()->current_test_info()->name() / name;
}

/// Runs `scene`, a shipped one or a path, with `options` on the CPU, without pictures unless
/// `pictures`.
inline HashedRun hashed_run(const std::string& name, const std::string& scene,
                            std::vector<std::string> options, const Environment& environment,
                            bool pictures = false) {
  const std::filesystem::path directory = run_folder(name);
  std::filesystem::remove_all(directory);
  std::filesystem::create_directories(directory);
  const std::string out = (directory / "out").string();
  std::vector<std::string> arguments{
      "run",          (std::filesystem::path(navvy::source_dir()) / "scenarios" / scene).string(),
      "--hash-every", "1",
      "--device",     "cpu",
      "--out",        out};
  if (!pictures) arguments.emplace_back("--no-render");
  arguments.insert(arguments.end(), options.begin(), options.end());
  HashedRun run;
  const std::string err = (directory / "stderr").string();
  run.status = test::wait_for(
      test::start({NAVVY_PROGRAM, arguments, environment, "/dev/null", "/dev/null", err}));
  const std::string said = text_of(err);
  EXPECT_EQ(run.status, 0) << said;
  std::istringstream lines(said);
  for (std::string line; std::getline(lines, line);)
    if (line.find("compute unit") != std::string::npos)
      run.device = line.substr(line.find("device"));
  std::istringstream rows(text_of(out + "/hashes.csv"));
  std::getline(rows, run.header);
  for (std::string row; std::getline(rows, row);) run.at[std::stoull(row)] = row;
  run.summary = nlohmann::json::parse(text_of(out + "/summary.json"), nullptr, false);
  return run;
}

inline std::vector<std::string> cells_of(const std::string& row) {
  std::vector<std::string> out;
  std::istringstream in(row);
  for (std::string cell; std::getline(in, cell, ',');) out.push_back(cell);
  return out;
}

/// Returns "" if all rows from `from` on are equal; else the first that differs, with its differing
/// parts.
inline std::string first_difference(const HashedRun& a, const HashedRun& b,
                                    std::uint64_t from = 0) {
  const std::vector<std::string> names = cells_of(a.header);
  for (auto row = a.at.lower_bound(from); row != a.at.end(); ++row) {
    const auto other = b.at.find(row->first);
    if (other == b.at.end())
      return "step " + std::to_string(row->first) + " is missing in the second run";
    if (row->second == other->second) continue;
    const std::vector<std::string> one = cells_of(row->second), two = cells_of(other->second);
    std::string out = "first different at step " + one[0] + ", t = " + one[1] + " s, in";
    for (std::size_t i = 2; i < std::min(one.size(), two.size()); ++i)
      if (one[i] != two[i]) out += " " + names[i];
    return out;
  }
  if (a.at.empty()) return "no rows at all";
  return a.header == b.header ? "" : "the columns differ";
}

}  // namespace navvy::determinism
