// SPDX-License-Identifier: Apache-2.0
// Short versions of the tool rigs; the full sizes and half cells run in
// tests/validation/lab_tools_test.cpp.
#include <cmath>

#include "core/math.h"
#include "lab/run_rig.h"

namespace navvy::lab {
namespace {

TEST(LabBlade, SmoothWideBladeMeetsThePassivePressure) {
  const Report report = run_rig("blade", {});
  EXPECT_EQ(outside_tolerance(report), "");
  EXPECT_EQ(measured(report, "particles through the blade"), 0);
  EXPECT_LT(measured(report, "momentum residual"), 1e-5);
  EXPECT_EQ(report.ledger_error, 0);
}

TEST(LabTip, PlateFeelsTheBearingCapacityAndKeepsItWhenItStops) {
  const Report report = run_rig("tip", {{"hold", 2}});
  EXPECT_EQ(outside_tolerance(report), "");
  EXPECT_EQ(measured(report, "particles through the plate"), 0);
  EXPECT_LT(measured(report, "momentum residual"), 1e-5);
}

TEST(LabBlade, ForceDoesNotDependOnTheStep) {
  // Transfers last a fixed time [docs/soil.md, transfer]; with one in every step it is 7.7 %.
  const auto force = [](double courant) {
    return measured(run_rig("blade", {{"courant", courant}, {"tolerance-percent", 0}}),
                    "horizontal force");
  };
  EXPECT_NEAR(force(0.25) / force(0.5), 1, 0.01);
}

TEST(LabBlade, CohesionAddsItsPart) {
  // A longer travel than sand needs: at 500 times the cohesion E is soft, and the force still rises
  // at 0.07 m.
  const Report report = run_rig("blade", {{"from", 0.05}, {"travel", 0.12}}, [](lab::Setup& s) {
    s.soil.cohesion = s.soil.residual_cohesion = 2000;
  });
  EXPECT_EQ(outside_tolerance(report), "");
}

TEST(LabBlade, FlatterBladeNeedsLessForce) {
  const std::map<std::string, double> open = {
      {"plane", 0}, {"width", 0.6}, {"tolerance-percent", 0}, {"travel", 0.2}, {"from", 0.1}};
  auto flat = open;
  flat["rake-deg"] = 45;
  const double upright = measured(run_rig("blade", open), "horizontal force");
  EXPECT_LT(measured(run_rig("blade", flat), "horizontal force"), 0.9 * upright);
}

TEST(LabBlade, RoughBladeMeetsTheWedgeUnderItsPile) {
  const Report report = run_rig("blade",
                                {{"rake-deg", 60},
                                 {"depth", 0.15},
                                 {"length", 0.3},
                                 {"tolerance-percent", 0},
                                 {"from", 0.2},
                                 {"travel", 0.25}},
                                [](lab::Setup& s) {
                                  s.cell = 0.05;
                                  s.soil.tool_friction_angle = radians(25);
                                });
  const Quantity* force = report.find("horizontal force at the end");
  ASSERT_NE(force, nullptr);
  // 6 cells of blade, 0.3 m/s.
  EXPECT_NEAR(force->measured / force->expected, 1, 0.2);
  // The whole tool friction acts: the force is inclined by the rake's complement minus delta, 5
  // deg.
  const double down = measured(report, "vertical force on the blade, down");
  EXPECT_NEAR(degrees(std::atan2(down, measured(report, "horizontal force"))), 5, 2);
  EXPECT_EQ(measured(report, "particles through the blade"), 0);
  EXPECT_EQ(report.ledger_error, 0);
}

TEST(LabBlade, RoughUprightBladeIsComparedWithItsBoundsNotWithTheWedge) {
  const Report report = run_rig("blade", {}, [](lab::Setup& s) {
    s.soil.tool_friction_angle = radians(20);
    s.soil.young_modulus = 4e6;
  });
  const Quantity* force = report.find("horizontal force");
  const Quantity* wedge = report.find("horizontal force, against the wedge");
  ASSERT_NE(force, nullptr);
  ASSERT_NE(wedge, nullptr);
  EXPECT_TRUE(force->judged());
  EXPECT_NE(force->source.find("[Lancellotta 2002]"), std::string::npos);
  EXPECT_FALSE(wedge->has_tolerance());
  // The wedge is an upper bound: the tolerance ends below it.
  EXPECT_GT(wedge->expected, force->high);
  // Three cells deep.
  EXPECT_NEAR(force->measured / force->expected, 1, 0.2);
}

TEST(LabBlade, SofteningSoilIsNotComparedWithIntactCohesion) {
  const Report report = run_rig("blade", {{"travel", 0.04}}, [](lab::Setup& s) {
    s.soil.cohesion = 4000;
    s.soil.residual_cohesion = 500;
  });
  const Quantity* force = report.find("horizontal force");
  ASSERT_NE(force, nullptr);
  EXPECT_FALSE(force->judged());
  // The expectation is that of the residual soil; that of the intact soil is listed without a
  // tolerance.
  EXPECT_NEAR(force->expected,
              0.5 * 16e2 * kGravity * 0.09 * 3.6902 + 2 * 500 * 0.3 * std::sqrt(3.6902), 1);
  ASSERT_NE(report.find("horizontal force, were the soil intact"), nullptr);
  EXPECT_FALSE(report.find("horizontal force, were the soil intact")->has_tolerance());
}

/// Returns the series of travel; empty if there is none.
std::vector<double> travel_of(const Report& report) {
  for (const Series& series : report.series)
    if (series.name == "travel") return series.values;
  return {};
}

TEST(LabBlade, ReachesItsSpeedOverTheRampAndItsEnd) {
  const auto travel = [](double ramp) {
    return travel_of(run_rig("blade", {{"ramp", ramp}, {"travel", 0.04}}));
  };
  const std::vector<double> sudden = travel(0), ramped = travel(0.02);
  ASSERT_GT(sudden.size(), 10u);
  ASSERT_GT(ramped.size(), sudden.size());
  EXPECT_NEAR(ramped.back(), 0.04, 1e-6);
  EXPECT_NEAR(sudden.back(), 0.04, 1e-6);
  // Constant acceleration from rest: travel grows with the square of the steps, and the first one
  // is tiny.
  EXPECT_LT(ramped.front(), 0.1 * sudden.front());
  const std::size_t half = 20 * ramped.size() / 60;
  EXPECT_NEAR(ramped[half] / ramped[half / 2], 4, 0.5);
}

TEST(LabWall, ActiveWallIsSlowAndOtherwiseNotJudged) {
  // A small wall, to check the report's statements and not its force.
  const std::map<std::string, double> small = {
      {"height", 0.4}, {"travel", -0.03}, {"wait", 0.05}, {"ahead", 1}};
  const auto coarse = [](lab::Setup& s) { s.cell = 0.1; };
  const Report slow = run_rig("wall", small, coarse);
  // 0.01 m/s and a ramp.
  EXPECT_GT(slow.simulated_time, 0.03 * 0.4 / 0.01);
  // Four cells of height.
  EXPECT_FALSE(slow.find("active force")->judged());
  auto quick = small;
  quick["speed"] = 0.05;
  EXPECT_LT(run_rig("wall", quick, coarse).simulated_time, 0.5 * slow.simulated_time);
}

TEST(LabWall, ReportsTheResidualForceAfterTheWallStops) {
  std::map<std::string, double> small = {
      {"height", 0.4}, {"travel", 0.1}, {"wait", 0.05}, {"ahead", 1}};
  const auto coarse = [](lab::Setup& s) { s.cell = 0.1; };
  const char* const residual = "force after the stop / force before it";
  EXPECT_EQ(run_rig("wall", small, coarse).find(residual), nullptr);
  small["hold"] = 0.3;
  const Report report = run_rig("wall", small, coarse);
  ASSERT_NE(report.find(residual), nullptr);
  // It stops; the soil loses some, but not all, of the force that moved it.
  const std::vector<double> travel = travel_of(report);
  ASSERT_FALSE(travel.empty());
  EXPECT_NEAR(travel.back(), 0.04, 1e-6);
  EXPECT_GT(report.find(residual)->measured, 0.3);
  EXPECT_LT(report.find(residual)->measured, 0.97);
  EXPECT_GT(report.simulated_time, 0.05 + 0.04 / 0.1 + 0.3);
}

TEST(LabFooting, CarriesFourTimesTheCohesionAtHalfTheCellsOfTheTolerance) {
  // Ten cells of breadth give 0.85 of Prandtl's 5.14, and twenty give 0.96, which the tolerance
  // requires. With a transfer in every step ten cells gave more: the viscosity of transfers carried
  // the rest.
  const Report report = run_rig("footing", {}, [](lab::Setup& s) { s.cell = 0.1; });
  EXPECT_NEAR(measured(report, "Nc = pressure / c"), 4.36, 0.05 * 4.36);
  EXPECT_EQ(measured(report, "particles through the shell"), 0);
  EXPECT_EQ(report.ledger_error, 0);
}

TEST(LabHold, WeightOfTheLoadIsMeasuredWithinOnePercent) {
  const Report report = run_rig("hold", {{"time", 2}});
  EXPECT_EQ(outside_tolerance(report), "");
  EXPECT_EQ(measured(report, "particles through the shell"), 0);
}

TEST(LabHold, ShellOfHalfTheLoadHangsAtRest) {
  for (const double share : {1.0, 0.5}) {
    const Report report =
        run_rig("hold", {{"time", 2}, {"mass", 1400}, {"shell-mass", 700}, {"step-share", share}});
    EXPECT_EQ(outside_tolerance(report), "") << "step share " << share;
  }
}

TEST(LabLightTool, GainsNoEnergy) {
  const Report report = run_rig("light-tool", {});
  EXPECT_EQ(outside_tolerance(report), "");
  EXPECT_LT(measured(report, "momentum residual"), 1e-5);
}

TEST(LabScrape, NeitherJamsNorThrowsSoil) {
  // The whole travel: after half of it the pressed floor has separated.
  const Report report = run_rig("scrape", {});
  EXPECT_EQ(outside_tolerance(report), "");
  EXPECT_EQ(measured(report, "particles through the shell"), 0);
}

TEST(LabRigs, NamesAndParametersAreUnique) {
  std::map<std::string, int> seen;
  for (const Rig& rig : rigs()) {
    EXPECT_EQ(seen[rig.name]++, 0) << rig.name;
    EXPECT_FALSE(rig.drawing.empty()) << rig.name;
    EXPECT_NE(rig.experiment, nullptr) << rig.name;
    std::map<std::string, int> names;
    for (const Parameter& parameter : rig.parameters)
      EXPECT_EQ(names[parameter.name]++, 0) << parameter.name;
  }
}

}  // namespace
}  // namespace navvy::lab
