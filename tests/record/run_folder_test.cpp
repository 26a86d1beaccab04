// SPDX-License-Identifier: Apache-2.0
// tests/record/run_1 is a folder that `navvy run` wrote in format 1. It never changes, and every
// later version must read it: results of users outlive the program that wrote them.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "control/step_kinds.h"
#include "core/error.h"
#include "core/file.h"
#include "folder.h"
#include "paths.h"
#include "record/run_info.h"
#include "record/summary.h"
#include "scene_io/loader.h"

namespace navvy::record {
namespace {

const std::string kKept = navvy::source_dir() + "/tests/record/run_1";

std::string text_of(const std::string& file) {
  const std::vector<char> bytes = read_file(kKept + "/" + file);
  return std::string(bytes.begin(), bytes.end());
}

TEST(RunFolder, OfFormat1ReportsTheProgramThatWroteIt) {
  const RunInfo info = read_run_info(kKept);
  EXPECT_EQ(info.format, 1);
  EXPECT_EQ(info.version, "0.1.0");
  ASSERT_EQ(info.command.size(), 15u);
  EXPECT_EQ(info.command[0], "navvy");
  EXPECT_EQ(info.command[2], "scenarios/bucket_path.sdf");
  EXPECT_EQ(info.scene, "scenarios/bucket_path.sdf");
  EXPECT_FALSE(info.device.empty());
}

TEST(RunFolder, OfFormat1HasASceneWithEveryOverride) {
  EXPECT_TRUE(scene_io::check(kKept + "/scene.sdf", control::step_kinds()).empty());
  const scene::Scene world = scene_io::load_scene(kKept + "/scene.sdf", control::step_kinds());
  EXPECT_EQ(world.name, "bucket_path");
  EXPECT_EQ(world.seed, 5u);                 // --seed 5
  EXPECT_EQ(world.recording.duration, 0.1);  // --duration 0.1
  EXPECT_FALSE(world.recording.render);      // --no-render
  ASSERT_EQ(world.soils.size(), 1u);
  EXPECT_EQ(world.soils[0].name, "loam");
  EXPECT_EQ(world.soils[0].cohesion, 8000);  // --set soil.cohesion_pa=8000
  ASSERT_EQ(world.machines.size(), 1u);
  EXPECT_EQ(world.machines[0].name, "bucket");
  EXPECT_EQ(world.machines[0].machine.joints.size(), 3u);
  EXPECT_EQ(world.machines[0].program.steps.size(), 1u);
}

TEST(RunFolder, OfFormat1HasResultsThatScriptsRead) {
  const auto summary = nlohmann::json::parse(text_of("summary.json"));
  EXPECT_EQ(summary.at("schema_version"), 1);
  EXPECT_EQ(summary.at("status"), "finished");
  EXPECT_EQ(summary.at("mass_ledger").at("error_units"), 0);
  std::istringstream telemetry(text_of("telemetry.csv"));
  std::string header, row;
  ASSERT_TRUE(std::getline(telemetry, header));
  EXPECT_EQ(header.rfind("time [s],soil/particles [1],bucket/slide_x/position [m]", 0), 0u)
      << header;
  ASSERT_TRUE(std::getline(telemetry, row));
  EXPECT_EQ(std::count(row.begin(), row.end(), ','), std::count(header.begin(), header.end(), ','));
}

TEST(RunFolder, OfALaterFormatIsRefusedAndNoFolderIsReported) {
  const test::Folder folder;
  write_file_atomically(folder / "run.json", std::string(R"({"format": 2, "navvy": "9.0.0"})"));
  try {
    read_run_info(folder.path().string());
    FAIL() << "a later format was accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("up to format 1"), std::string::npos) << error.what();
  }
  write_file_atomically(folder / "run.json", std::string("[]"));
  EXPECT_THROW(read_run_info(folder.path().string()), InputError);
  EXPECT_THROW(read_run_info(folder / "none"), FileError);
}

TEST(RunFolder, TextIsReadBackUnchanged) {
  const test::Folder folder;
  const RunInfo info{kRunFormat,
                     navvy_version(),
                     {"navvy", "run", "a \"b\" c"},
                     "a.sdf",
                     "some device",
                     {"0123456789abcdef", "kernels", {"soil/law.h"}},
                     "groups",
                     {{"NAVVY_FEW_PARTICLES", "0"}}};
  write_file_atomically(folder / "run.json", run_json(info));
  const RunInfo read = read_run_info(folder.path().string());
  EXPECT_EQ(read.version, info.version);
  EXPECT_EQ(read.command, info.command);
  EXPECT_EQ(read.scene, info.scene);
  EXPECT_EQ(read.device, info.device);
  EXPECT_EQ(read.kernels.hash, info.kernels.hash);
  EXPECT_EQ(read.kernels.folder, info.kernels.folder);
  EXPECT_EQ(read.kernels.changed, info.kernels.changed);
  EXPECT_EQ(read.schedule, info.schedule);
  EXPECT_EQ(read.environment, info.environment);
}

TEST(RunFolder, EnvironmentOfARunHoldsWhatDecidesIt) {
  ::setenv("NAVVY_FEW_PARTICLES", "0", 1);
  ::setenv("POCL_CACHE_DIR", "/somewhere", 1);
  const std::map<std::string, std::string> found = deciding_environment();
  ::unsetenv("NAVVY_FEW_PARTICLES");
  ::unsetenv("POCL_CACHE_DIR");
  EXPECT_EQ(found.at("NAVVY_FEW_PARTICLES"), "0");
  EXPECT_EQ(found.count("POCL_CACHE_DIR"), 0u);
  EXPECT_EQ(found.count("PATH"), 0u);
  EXPECT_EQ(deciding_environment().count("NAVVY_FEW_PARTICLES"), 0u);
}

}  // namespace
}  // namespace navvy::record
