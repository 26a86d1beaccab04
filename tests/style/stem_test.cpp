// SPDX-License-Identifier: Apache-2.0
// One stem for one stage: its kernel, host, test and bench have the same name.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "style/sources.h"

namespace navvy::style {
namespace {

std::string file_of(const std::string& path) { return path.substr(path.rfind('/') + 1); }

std::string stem_of(const std::string& path) {
  const std::string file = file_of(path);
  return file.substr(0, file.find('.'));
}

/// Returns the stems of a schedule's kernels.
std::vector<std::string> stages(const std::string& schedule) {
  std::vector<std::string> out;
  for (const SourceFile& file : sources("kernels/soil/" + schedule, {".cl"}))
    out.push_back(stem_of(file.path));
  return out;
}

/// Returns true if a file below `folder` is named `begin` + anything + `end`.
bool has_file(const std::string& folder, const std::string& begin, const std::string& end) {
  const std::vector<SourceFile> files = sources(folder, {".h", ".cpp"});
  return std::any_of(files.begin(), files.end(), [&](const SourceFile& file) {
    return file_of(file.path).compare(0, begin.size(), begin) == 0 && file.ends_with(end);
  });
}

TEST(Stems, OfKernelsAreThoseOfHostAndTest) {
  std::vector<std::string> found;
  const std::vector<std::string> all = stages("lanes");
  ASSERT_FALSE(all.empty());
  for (const std::string& stem : all) {
    if (!has_file("src/soil", stem + ".h", ".h"))
      found.push_back(stem + ": no src/soil/**/" + stem + ".h");
    if (!has_file("src/soil", stem + ".cpp", ".cpp"))
      found.push_back(stem + ": no src/soil/**/" + stem + ".cpp");
    if (!has_file("tests/soil", stem + "_", "_test.cpp"))
      found.push_back(stem + ": no tests/soil/**/" + stem + "_*_test.cpp");
  }
  EXPECT_EQ(report(found), "");
}

TEST(Stems, OfBothSchedulesAreTheSame) { EXPECT_EQ(stages("lanes"), stages("groups")); }

TEST(Stems, OfKernelsHaveARowInABench) {
  // Kernels are timed inside whole steps, where memory and neighbours are as in a run: `soil_bench
  // --profile` prints a row for each. Case of soil_bench in which a stage costs most:
  const std::map<std::string, std::string> cases = {{"particle_to_grid", "collapse_64k"},
                                                    {"grid_update", "collapse_64k"},
                                                    {"grid_to_particle", "collapse_64k"},
                                                    {"rebin", "collapse_8k"},
                                                    {"mass_count", "collapse_64k"},
                                                    {"shell", "dig"},
                                                    {"edge", "dig"},
                                                    {"contact", "held_bucket"}};
  const std::vector<SourceFile> bench = sources("bench/kernels", {"soil_bench.cpp"});
  ASSERT_EQ(bench.size(), 1u);
  std::vector<std::string> found;
  for (const std::string& stem : stages("lanes")) {
    const auto row = cases.find(stem);
    if (row == cases.end())
      found.push_back(stem + ": no case of bench/kernels/soil_bench.cpp is named here");
    else if (bench.front().text.find("run(\"" + row->second + "\"") == std::string::npos)
      found.push_back(stem + ": soil_bench has no case " + row->second);
  }
  EXPECT_EQ(report(found), "");
}

}  // namespace
}  // namespace navvy::style
