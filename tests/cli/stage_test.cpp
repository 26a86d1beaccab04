// SPDX-License-Identifier: Apache-2.0
// `navvy stage`, and runs that go on from its snapshots.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/program_run.h"
#include "text_of.h"

namespace navvy::test {
namespace {

class Stage : public ProgramRun {
 protected:
  /// Runs jobs/pit on coarse cells for `duration` seconds from a snapshot, and returns its summary.
  nlohmann::json go_on(const std::string& snapshot, const std::string& duration) {
    EXPECT_EQ(
        run({"run", "jobs/pit", "--set", "solver.cell_m=0.2", "--resume", snapshot, "--duration",
             duration, "--no-render", "--no-report", "--quiet", "--out", out()}),
        0)
        << complained();
    return summary();
  }
};

TEST_F(Stage, MakesSitesAtRestOnWhichTheJobGoesOn) {
  for (const std::string share : {"0.25", "0.75"}) {
    const std::string file = path(share + ".snapshot");
    ASSERT_EQ(
        run({"stage", "jobs/pit", "--set", "solver.cell_m=0.2", "--done", share, "--out", file}), 0)
        << complained();
    EXPECT_NE(said().find("of the job"), std::string::npos) << said();
    EXPECT_NE(said().find("navvy run jobs/pit --set 'solver.cell_m=0.2' --resume"),
              std::string::npos)
        << said();
    const nlohmann::json result = go_on(file, "1");
    const nlohmann::json& ledger = result.at("mass_ledger");
    EXPECT_EQ(ledger.at("error_units"), 0);
    for (const nlohmann::json& soil : ledger.at("soils"))
      EXPECT_EQ(soil.at("particles_kg"), 0) << "soil slid from a slope";
    EXPECT_NEAR(result.at("score").at("shape").at("completion").get<double>(), std::stod(share),
                0.02);
  }
}

TEST_F(Stage, RefusesWithRemedy) {
  EXPECT_EQ(run({"stage", "jobs/pit", "--done", "1.5", "--out", path("a.snapshot")}), 2);
  expect_complained("from 0.01 to 1");
  EXPECT_EQ(run({"stage", "haul", "--out", path("a.snapshot")}), 2);
  expect_complained("add a dig_area or a grade");
  EXPECT_EQ(run({"stage", "jobs/pit", "--machine", "truck", "--out", path("a.snapshot")}), 2);
  expect_complained("is no machine of the scene");
  std::ofstream(path("precious")) << "text";
  EXPECT_EQ(run({"stage", "jobs/pit", "--out", path("precious")}), 2);
  expect_complained("no snapshot, so it is not replaced");
  EXPECT_EQ(text_of(path("precious")), "text");
}

}  // namespace
}  // namespace navvy::test
