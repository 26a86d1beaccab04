// SPDX-License-Identifier: Apache-2.0
// go_to around bodies: a wall, a parked machine, a wall that an input moves; and the check before a
// run.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "control/step_kinds.h"
#include "map/map_maker.h"
#include "paths.h"
#include "planner/footprint.h"
#include "planner/map_path_planner.h"
#include "run/scene_check.h"
#include "run/simulation.h"
#include "scene_io/loader.h"
#include "sim/occupied_areas.h"

namespace navvy::run {
namespace {

constexpr double kClearance = 0.3;  // the default of go_to

/// Returns a site of 30 m x 20 m with a light truck at (-8, 0) that goes to `goal`, and `bodies`.
scene::Scene site(const std::string& goal, const std::string& bodies) {
  return scene_io::load_scene_from_string(
      "<sdf version=\"1.9\" xmlns:navvy=\"navvy\"><world name=\"bodies\"><navvy:soil "
      "ref=\"gravel\"/>\n<navvy:ground><size_m>30 "
      "20</size_m><depth_m>0.5</depth_m></navvy:ground>\n"
      "<include><uri>model://light_truck</uri><name>truck</name><pose>-8 0 0 0 0 0</pose>"
      "<navvy:program><go_to><target_m>" +
          goal +
          "</target_m><heading_deg>0</heading_deg><speed_m_per_s>2</speed_m_per_s></go_to>"
          "</navvy:program></include>\n" +
          bodies +
          "<navvy:recording><duration_s>60</duration_s><render>false</render></navvy:recording>"
          "</world></sdf>",
      navvy::source_dir() + "/scenarios/bodies.sdf", control::step_kinds());
}

/// Returns a wall across the site, 0.5 m thick and `length` long.
std::string wall(const std::string& place, double length, const std::string& kind) {
  return "<model name=\"wall\">" + kind + "<pose>" + place +
         " 0.5 0 0 0</pose><navvy:on_ground>false</navvy:on_ground><link name=\"l\"><collision "
         "name=\"c\"><geometry><box><size>0.5 " +
         std::to_string(length) + " 1</size></box></geometry></collision></link></model>\n";
}

/// Returns the distance of the truck's footprint from everything else, at most 1 m.
double clearance_now(const Simulation& simulation) {
  const sim::World& world = simulation.world();
  const sim::MachineHandle truck = world.machines().at("truck");
  map::MapMaker maker({{map::MapLayer::kTraversability}, {}, {}});
  maker.update(
      world.ground().view().with(std::make_shared<const std::vector<heightfield::OccupiedArea>>(
          sim::occupied_areas(world, sim::bodies_around(world, truck.index())))));
  const Pose X_WB = truck.link(0).pose();
  return planner::clearance(maker.map(), planner::footprint_of(truck.description()),
                            X_WB.translation().x(), X_WB.translation().y(),
                            std::atan2(X_WB.linear()(1, 0), X_WB.linear()(0, 0)), 1);
}

class BodiesOnPath : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!planner::path_planners())
      GTEST_SKIP() << "no OMPL in this build: install libompl-dev and build with NAVVY_WITH_OMPL";
  }
};

/// Runs to the end and returns the least clearance of the truck on its path.
double least_clearance(Simulation& simulation) {
  double least = 1;
  while (!simulation.done()) {
    simulation.step(100);
    least = std::min(least, clearance_now(simulation));
  }
  std::printf("clearance %.3f m after %.1f s\n", least, simulation.time());
  return least;
}

void expect_done(const Simulation& simulation) {
  const session::ProgramReport report = simulation.session().programs().at(0);
  EXPECT_EQ(report.last().state, control::StepState::kDone) << report.last().reason;
}

TEST_F(BodiesOnPath, AWallIsDrivenAround) {
  Simulation simulation(site("8 0", wall("0 0", 6, "<static>true</static>")));
  EXPECT_GE(least_clearance(simulation), kClearance);
  expect_done(simulation);
}

TEST_F(BodiesOnPath, AParkedMachineIsDrivenAround) {
  Simulation simulation(site(
      "9 0",
      "<include><uri>model://ew180</uri><name>parked</name><pose>0 0 0 0 0 1.57</pose></include>"));
  EXPECT_GE(least_clearance(simulation), kClearance);
  expect_done(simulation);
}

TEST_F(BodiesOnPath, AWallThatAnInputMovesCausesANewPlan) {
  Simulation simulation(site("8 0", wall("0 7", 4, "<navvy:physics>kinematic</navvy:physics>")));
  simulation.step(1500);
  EXPECT_EQ(simulation.session().programs().at(0).paths.size(), 1u);
  simulation.set("wall/pose/y", 0);
  EXPECT_GE(least_clearance(simulation), kClearance);
  expect_done(simulation);
  EXPECT_GE(simulation.session().programs().at(0).paths.size(), 2u);
}

TEST_F(BodiesOnPath, ChecksAGoalThatLiesInABody) {
  EXPECT_TRUE(check_scene(site("8 0", wall("0 0", 6, "<static>true</static>"))).faults.empty());
  const std::vector<Fault> faults =
      check_scene(site("0 0", wall("0 0", 6, "<static>true</static>"))).faults;
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(faults[0].severity, Fault::Severity::kError);
  EXPECT_NE(faults[0].text().find("would stand 0.00 m from ground that it cannot drive on, or from "
                                  "a body"),
            std::string::npos)
      << faults[0].text();
}

}  // namespace
}  // namespace navvy::run
