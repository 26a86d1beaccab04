// SPDX-License-Identifier: Apache-2.0
// The excavator digs across its own path and drives around the trench: with 1 and 2 threads, and
// resumed on the path.
#include <cstdlib>

#include "determinism/hashed_run.h"

namespace navvy::determinism {
namespace {

/// Returns a value of the last step of the program, a go_to.
double value_of(const HashedRun& run, const std::string& name) {
  return run.summary.at("programs").at(0).at("step_list").back().at(name).get<double>();
}

/// Returns true if plan `number` crosses the trench with the middle of the rear axle.
bool crosses_trench(const std::string& name, int number) {
  std::istringstream rows(text_of((run_folder(name) / "out" / "paths.csv").string()));
  std::string row;
  std::getline(rows, row);
  while (std::getline(rows, row)) {
    const std::vector<std::string> cell = cells_of(row);
    const double x = std::atof(cell.at(5).c_str()), y = std::atof(cell.at(6).c_str());
    if (cell.at(2) == std::to_string(number) && x > 0 && x < 2.4 && std::abs(y) < 0.5) return true;
  }
  return false;
}

TEST(DriveAround, DrivesAroundItsOwnTrenchBitIdentically) {
  const std::string snapshot = (run_folder("snapshots") / "mid_path").string();
  std::filesystem::create_directories(run_folder("snapshots"));
  const HashedRun one = hashed_run("one", "drive_around_trench.sdf",
                                   {"--snapshot", snapshot, "--snapshot-at", "62"}, threads(1));
  const HashedRun two = hashed_run("two", "drive_around_trench.sdf", {}, threads(2));
  const HashedRun rest =
      hashed_run("resumed", "drive_around_trench.sdf", {"--resume", snapshot}, threads(2));
  EXPECT_EQ(first_difference(one, two), "");
  ASSERT_FALSE(rest.at.empty());
  EXPECT_EQ(first_difference(one, rest, rest.at.begin()->first), "");
  for (const HashedRun* run : {&one, &two, &rest}) {
    EXPECT_EQ(run->summary.at("status"), "finished");
    EXPECT_EQ(run->summary.at("state_hash"), one.summary.at("state_hash"));
    for (const char* name :
         {"plans", "cusps", "driven_m", "goal_error_m", "goal_error_deg", "least_clearance_m"})
      std::printf("%s: %g\n", name, value_of(*run, name));
    EXPECT_GE(value_of(*run, "plans"), 2);
    EXPECT_LT(value_of(*run, "goal_error_m"), 0.5);
    EXPECT_LT(value_of(*run, "goal_error_deg"), 5);
    EXPECT_GE(value_of(*run, "least_clearance_m"), 0.3);
  }
  for (const char* name : {"one", "two", "resumed"}) {
    EXPECT_TRUE(crosses_trench(name, 1)) << "the path planned before the dig";
    EXPECT_FALSE(crosses_trench(name, 2)) << "the one planned after it";
  }
}

}  // namespace
}  // namespace navvy::determinism
