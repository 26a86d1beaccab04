// SPDX-License-Identifier: Apache-2.0
// `navvy bench`, and what a run records about the kernels that it used.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/program_run.h"

namespace navvy {
namespace {

namespace fs = std::filesystem;

using test::text_of;

class Bench : public test::ProgramRun {};
class Kernels : public test::ProgramRun {
 protected:
  /// Runs a bucket for some steps and returns run.json.
  nlohmann::json info_of_run() {
    const std::string scene = source_dir() + "/scenarios/bucket_path.sdf";
    EXPECT_EQ(run({"run", scene, "--no-render", "--duration", "0.01", "--out", out()}), 0)
        << complained();
    return nlohmann::json::parse(text_of(out() + "/run.json"));
  }
};

TEST_F(Kernels, OfARunAreTheShippedOnes) {
  environment_ = {{"NAVVY_SOIL_SCHEDULE", "groups"}};
  const nlohmann::json info = info_of_run();
  EXPECT_EQ(info.at("kernels").at("shipped"), true);
  EXPECT_EQ(info.at("kernels").at("hash").get<std::string>().size(), 16u);
  EXPECT_FALSE(info.at("kernels").contains("folder"));
  EXPECT_EQ(info.at("schedule"), "groups");
  EXPECT_EQ(info.at("environment").at("NAVVY_SOIL_SCHEDULE"), "groups");
  EXPECT_EQ(complained().find("not the shipped ones"), std::string::npos);
}

TEST_F(Kernels, ThatWereEditedAreNamedInLogAndFolder) {
  const std::string kernels = path("kernels");
  fs::copy(source_dir() + "/kernels", kernels, fs::copy_options::recursive);
  std::ofstream(kernels + "/soil/law.h", std::ios::app) << "// edited\n";
  environment_ = {{"NAVVY_KERNEL_DIR", kernels}};
  const nlohmann::json info = info_of_run();
  EXPECT_NE((said() + complained()).find("not the shipped ones: soil/law.h differs"),
            std::string::npos);
  EXPECT_EQ(info.at("kernels").at("shipped"), false);
  EXPECT_EQ(info.at("kernels").at("folder"), kernels);
  EXPECT_EQ(info.at("kernels").at("changed"), nlohmann::json({"soil/law.h"}));
}

TEST_F(Bench, OfAShippedSoilNamesIt) {
  ASSERT_EQ(run({"bench", "held", "--soil", "loam", "--json", path("rows.json")}), 0)
      << complained();
  const auto rows = nlohmann::json::parse(text_of(path("rows.json")));
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].at("bench"), "soil_held_bucket@loam");
  EXPECT_GT(rows[0].at("fma_flops_per_s"), 0);
  EXPECT_GT(rows[0].at("copy_bytes_per_s"), 0);
  EXPECT_EQ(run({"bench", "held", "--soil", "looam"}), 2);
  expect_complained("did you mean 'loam'");
}

TEST_F(Bench, ModelIsPrintedBesideTheRowsAndNeedsSeveral) {
  ASSERT_EQ(run({"bench", "--quick", "--model"}), 0) << complained();
  for (const char* part :
       {"Processor time of a soil step, fitted to 6 rows", "A bucket in the ground", "1000000"})
    EXPECT_NE(said().find(part), std::string::npos) << part << " is not in:\n" << said();
  EXPECT_EQ(run({"bench", "held", "--model"}), 2);
  expect_complained("at least 4 rows");
}

TEST_F(Bench, NativeComparesWithTheLoop) {
  ASSERT_EQ(run({"bench", "8k", "--native"}), 0) << complained();
  EXPECT_NE(said().find("native_loop:8k: OpenCL steps / native loop"), std::string::npos) << said();
  EXPECT_EQ(run({"bench", "9k", "--native"}), 2);
  expect_complained("one of: 8k 64k 405k");
}

}  // namespace
}  // namespace navvy
