// SPDX-License-Identifier: Apache-2.0
// `navvy lab iso6015`, `iso10567` and `iso11152` as a process: tables, CSV, JSON, endings, and bad
// input.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/program_run.h"

namespace navvy {
namespace {

using nlohmann::json;

class Rating : public test::ProgramRun {
 protected:
  json read(const std::string& name) const { return json::parse(test::text_of(path(name))); }
};

TEST_F(Rating, GivesToolForcesOfAllShippedMachinesWithABucket) {
  ASSERT_EQ(run({"lab", "iso6015", "--csv", path("forces.csv"), "--json", path("forces.json")}), 0)
      << complained();
  EXPECT_NE(said().find("test_bucket is left out: navvy:arm"), std::string::npos) << said();
  const json forces = read("forces.json").at("forces");
  ASSERT_EQ(forces.size(), 4u) << "ew180 and ex180_tracked, two forces each";
  for (const json& one : forces) {
    const bool breakout = one.at("force") == "breakout";
    EXPECT_NEAR(one.at("rated").at("hydraulic_n").get<double>(), breakout ? 120e3 : 90e3, 6e3);
    EXPECT_LE(one.at("standing").at("standing_n").get<double>(),
              one.at("rated").at("hydraulic_n").get<double>() + 1);
    EXPECT_EQ(one.at("curve").size(), 41u);
    const std::string limit = one.at("standing").at("limit");
    EXPECT_TRUE(limit == "hydraulic" || limit == "tipping" || limit == "slipping") << limit;
  }
  // One line of the header, and 44 positions of each force.
  const std::string csv = test::text_of(path("forces.csv"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 4 * 44);
  EXPECT_EQ(csv.rfind("machine,force,position,", 0), 0u);
}

TEST_F(Rating, GivesLiftCapacityOverReachAndSwing) {
  ASSERT_EQ(run({"lab", "iso10567", "ew180", "--reach", "6", "--height", "1.5", "--swing-deg",
                 "0,90", "--json", path("lift.json"), "--csv", path("lift.csv")}),
            0)
      << complained();
  EXPECT_NE(said().find("over the left side"), std::string::npos) << said();
  const json lifts = read("lift.json").at("lifts");
  ASSERT_EQ(lifts.size(), 4u) << "at 6 m and at the largest reach, over front and side";
  for (const json& one : lifts) {
    const double rated = one.at("rated_kg"), hydraulic = one.at("hydraulic_kg");
    const double tipping = one.at("tipping_kg");
    EXPECT_NEAR(rated, std::min(0.87 * hydraulic, 0.75 * tipping), 1e-6 * rated);
  }
  EXPECT_LT(lifts[2].at("rated_kg").get<double>(), lifts[0].at("rated_kg").get<double>());
  // The usual grid has no place inside the machine and none that the arm does not reach.
  ASSERT_EQ(run({"lab", "iso10567", "ew180", "--json", path("chart.json")}), 0) << complained();
  EXPECT_GT(read("chart.json").at("lifts").size(), 20u);
}

TEST_F(Rating, WrapsHeadingsAndTellsTheSidesApart) {
  ASSERT_EQ(run({"lab", "iso10567", "ew180", "--reach", "6", "--height", "1.5", "--swing-deg",
                 "270,-90,-180,360", "--json", path("lift.json")}),
            0)
      << complained();
  EXPECT_NE(said().find("over the right side"), std::string::npos) << said();
  EXPECT_EQ(said().find("over the left side"), std::string::npos) << said();
  EXPECT_NE(said().find("over the rear"), std::string::npos) << said();
  EXPECT_NE(said().find("over the front"), std::string::npos) << said();
  const json lifts = read("lift.json").at("lifts");
  ASSERT_EQ(lifts.size(), 8u) << "at 6 m and at the largest reach";
  for (const std::size_t i : {0u, 1u}) EXPECT_EQ(lifts[i], lifts[i + 2]) << "270 is -90";
  EXPECT_NEAR(lifts[4].at("swing_deg").get<double>(), 180, 1e-9);
  EXPECT_EQ(lifts[6].at("swing_deg").get<double>(), 0);
}

TEST_F(Rating, RefusesBadInputWithARemedy) {
  EXPECT_EQ(run({"lab", "iso6015", "ew108"}), 2);
  EXPECT_NE(complained().find("did you mean 'ew180'"), std::string::npos) << complained();
  EXPECT_EQ(run({"lab", "iso10567", "test_bucket"}), 2);
  EXPECT_NE(complained().find("an arm with boom, stick and bucket"), std::string::npos)
      << complained();
  EXPECT_EQ(run({"lab", "iso10567", "ew180", "--reach", "-1"}), 2);
  EXPECT_EQ(run({"lab", "iso10567", "ew180", "--swing-deg", "nan"}), 2);
  EXPECT_EQ(run({"lab", "iso6051"}), 2);
  EXPECT_NE(complained().find("did you mean 'iso6015'"), std::string::npos) << complained();
  EXPECT_EQ(run({"lab", "iso6015", "ew180", "--csv", "/nowhere/a.csv"}), 4);
}

TEST_F(Rating, IsListedWithTheRigs) {
  ASSERT_EQ(run({"lab"}), 0) << complained();
  for (const char* name : {"iso6015", "iso10567", "iso11152", "wheel"})
    EXPECT_NE(said().find(name), std::string::npos) << name;
  ASSERT_EQ(run({"lab", "iso6015", "--help"}), 0);
  EXPECT_NE(said().find("relief pressure"), std::string::npos) << said();
}

TEST_F(Rating, ComparesEnergiesOfAMotionOnlyForAMachineWithABucket) {
  EXPECT_EQ(run({"lab", "iso11152", "paper/ackermann"}), 2);
  EXPECT_NE(complained().find("navvy:bucket"), std::string::npos) << complained();
  EXPECT_EQ(run({"lab", "iso11152", "two_excavators"}), 2);
  EXPECT_NE(complained().find("name one of them"), std::string::npos) << complained();
  // Both dig, and the mass is that of the whole site.
  EXPECT_EQ(run({"lab", "iso11152", "two_excavators", "--machine", "south"}), 2);
  EXPECT_NE(complained().find("'north'"), std::string::npos) << complained();
  EXPECT_NE(complained().find("remove the navvy:program of all but 'south'"), std::string::npos)
      << complained();
}

TEST_F(Rating, ReportsHowAComparedMotionEnded) {
  std::ofstream(path("cut.sdf")) << R"(<sdf version="1.9" xmlns:navvy="navvy"><world name="cut">
<navvy:soil ref="loam"/><navvy:ground><size_m>24 20</size_m><depth_m>4</depth_m></navvy:ground>
<navvy:solver><cell_m>0.2</cell_m></navvy:solver>
<include><uri>model://ew180</uri><name>excavator</name><navvy:program>
<wait><duration_s>5</duration_s></wait></navvy:program></include>
<navvy:recording><duration_s>0.1</duration_s></navvy:recording></world></sdf>)";
  EXPECT_EQ(run({"lab", "iso11152", path("cut.sdf"), "--quiet", "--json", path("cut.json")}), 6)
      << complained();
  EXPECT_NE(said().find("incomplete: 'excavator', step 1 of 1 (wait)"), std::string::npos)
      << said();
  const json cut = read("cut.json");
  EXPECT_EQ(cut.at("end"), "out_of_time");
  EXPECT_EQ(cut.at("unfinished").size(), 1u);
  EXPECT_EQ(cut.at("energy").size(), 2u) << "work and pump";
  EXPECT_TRUE(cut.at("joints").contains("boom_joint")) << cut;
  // A duration on the command line asks for no more.
  EXPECT_EQ(run({"lab", "iso11152", path("cut.sdf"), "--quiet", "--duration", "0.05"}), 0)
      << complained();
}

}  // namespace
}  // namespace navvy
