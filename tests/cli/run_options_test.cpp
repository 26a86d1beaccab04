// SPDX-License-Identifier: Apache-2.0
// Options of `navvy run` that cannot be fulfilled are refused before the run, or end it with a
// distinct status.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "cli/program_run.h"
#include "text_of.h"

namespace navvy {
namespace {

class RunOptions : public test::ProgramRun {
 protected:
  /// Runs a few steps with additional arguments.
  int short_run(const std::vector<std::string>& more, const std::string& input = "") {
    std::vector<std::string> words = {"run",  kScene,  "--no-render", "--duration",
                                      "0.05", "--out", out()};
    words.insert(words.end(), more.begin(), more.end());
    return run(words, input);
  }
  void expect_reported(const std::string& part) const {
    const std::string all = said() + complained();
    EXPECT_NE(all.find(part), std::string::npos) << all;
  }
  const std::string kScene = navvy::source_dir() + "/scenarios/bucket_path.sdf";
  std::string snapshot() const { return (directory_ / "state.snapshot").string(); }
};

TEST_F(RunOptions, PlanningPresetHasCoarseCellsThatSetOverrides) {
  const auto cell = [&] {
    const std::string scene = test::text_of(out() + "/scene.sdf");
    const std::string open = "<cell_m>";
    const std::size_t at = scene.find(open);
    return at == std::string::npos ? 0.0 : std::stod(scene.substr(at + open.size()));
  };
  ASSERT_EQ(short_run({"--preset", "planning"}), 0) << complained();
  EXPECT_EQ(cell(), 0.2);
  ASSERT_EQ(short_run({"--set", "solver.cell_m=0.125", "--preset", "planning"}), 0) << complained();
  EXPECT_EQ(cell(), 0.125);
  EXPECT_NE(short_run({"--preset", "quick"}), 0);
  expect_reported("planning");
}

TEST_F(RunOptions, RefusesASnapshotTimeBeyondTheDurationAndAcceptsThatOfTheEnd) {
  EXPECT_EQ(short_run({"--snapshot", snapshot(), "--snapshot-at", "5"}), 2);
  expect_reported("the run lasts at most 0.05 s");
  EXPECT_EQ(short_run({"--snapshot", snapshot(), "--snapshot-at", "-3"}), 2);
  EXPECT_EQ(short_run({"--snapshot", snapshot(), "--snapshot-at", "nan"}), 2);
  EXPECT_FALSE(std::filesystem::exists(snapshot()));
  EXPECT_EQ(short_run({"--snapshot", snapshot(), "--snapshot-at", "0.05"}), 0) << complained();
  EXPECT_TRUE(std::filesystem::exists(snapshot()));
  // No time is left to run after it.
  EXPECT_EQ(short_run({"--resume", snapshot()}), 2);
  expect_reported("nothing is left to run");
}

TEST_F(RunOptions, ASnapshotReplacesNeitherForeignFilesNorThoseOfTheRun) {
  const std::string notes = (directory_ / "notes.txt").string();
  std::ofstream(notes) << "mine";
  EXPECT_EQ(short_run({"--snapshot", notes, "--snapshot-at", "0"}), 2);
  expect_reported("exists and is no snapshot, so it is not replaced");
  EXPECT_EQ(test::text_of(notes), "mine");
  EXPECT_EQ(short_run({"--snapshot", out() + "/telemetry.csv", "--snapshot-at", "0"}), 2);
  expect_reported("is the name of a file that the run itself writes");
  EXPECT_FALSE(std::filesystem::exists(out()));
  // A snapshot replaces an older one, also next to the results.
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(short_run({"--snapshot", snapshot(), "--snapshot-at", "0"}), 0) << complained();
  }
}

TEST_F(RunOptions, ARunThatEndsBeforeTheRequestedSnapshotHasItsOwnStatus) {
  EXPECT_EQ(short_run({"--control", "stdio", "--snapshot", snapshot(), "--snapshot-at", "0.04"},
                      "{\"end\": true}\n"),
            4);
  expect_reported("before --snapshot-at 0.04");
}

TEST_F(RunOptions, AnEmptyFolderNameIsRefused) {
  EXPECT_EQ(run({"run", kScene, "--out", ""}), 2);
  expect_reported("the folder's name is empty");
}

TEST_F(RunOptions, ReportsPipesAndFoldersByTheirKind) {
  const std::string pipe = (directory_ / "pipe").string();
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(short_run({"--resume", pipe}), 2);
  expect_reported("it is a pipe");
  EXPECT_EQ(run({"check", kScene, "--terrain", directory_.string()}), 2);
  expect_reported("it is a directory");
}

TEST_F(RunOptions, ReportsMissingHeightsOfAMapBeforeTheyAreFilled) {
  // A column higher than any ground, and no declared meaning for it.
  const std::string map = (directory_ / "map.asc").string();
  std::string text = "ncols 20\nnrows 20\nxllcorner 0\nyllcorner 0\ncellsize 1\n";
  for (int row = 0; row < 20; ++row) {
    for (int column = 0; column < 20; ++column) text += column == 7 ? "1e38 " : "1.5 ";
    text += "\n";
  }
  std::ofstream(map) << text;
  const std::string scene = navvy::source_dir() + "/scenarios/block_collapse.sdf";
  EXPECT_EQ(run({"check", scene, "--terrain", map, "--size", "10,10"}), 0);
  expect_reported("10 of 100 map cells on the site (10 %, 10 m2) have no height");
  expect_reported("1e+38 cannot be a height of ground, and the file does not declare it as nodata");
  expect_reported("0 errors, 1 warning");
  // Other findings in the map are reported too.
  expect_reported("source   Arc/Info ASCII Grid, 20 x 20 cells of 1 x 1 m");
  expect_reported("none declared: 10 of 100 cells on the site (10 %), filled from up to 1 m away");
  // Once declared, it is a gap like any other.
  text.insert(text.find("1.5"), "NODATA_value 1e38\n");
  std::ofstream(map) << text;
  EXPECT_EQ(run({"check", scene, "--terrain", map, "--size", "10,10"}), 0);
  EXPECT_EQ(said().find("cannot be a height of ground"), std::string::npos) << said();
  expect_reported("declared as 1e+38: 10 of 100 cells on the site");
}

TEST_F(RunOptions, ReportsASnapshotOfAnotherSceneWithBothNames) {
  ASSERT_EQ(short_run({"--snapshot", snapshot(), "--snapshot-at", "0.02"}), 0) << complained();
  const std::string other = navvy::source_dir() + "/scenarios/block_collapse.sdf";
  for (const bool anyway : {false, true}) {
    std::vector<std::string> words = {"run",       other,      "--no-render", "--out",
                                      out() + "2", "--resume", snapshot()};
    if (anyway) words.push_back("--resume-anyway");
    EXPECT_EQ(run(words), 2);
    expect_reported("'block_collapse'");
    expect_reported("bucket_path");
    expect_reported("--resume-anyway allows other parameters, not another scene");
  }
}

}  // namespace
}  // namespace navvy
