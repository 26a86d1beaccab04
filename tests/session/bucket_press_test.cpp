// SPDX-License-Identifier: Apache-2.0
// A crawler presses loose loam with its bucket.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "control/step_kinds.h"
#include "core/error.h"
#include "device/device.h"
#include "paths.h"
#include "scene_io/loader.h"
#include "session/session.h"
#include "values.h"

namespace navvy::session {
namespace {

/// Returns a crawler before a patch of loose loam, 0.4 m deep, in which it presses an area of
/// 0.9 x 0.9 m once.
scene::Scene loose_patch() {
  return scene_io::load_scene_from_string(
      "<sdf version=\"1.9\" xmlns:navvy=\"navvy\"><world name=\"press\"><navvy:soil ref=\"loam\"/>"
      "<navvy:soil name=\"loose\"><bank_density_kg_per_m3>1250</bank_density_kg_per_m3>"
      "<swell>1</swell><friction_angle_deg>30</friction_angle_deg><cohesion_pa>1500</cohesion_pa>"
      "<residual_cohesion_pa>1500</residual_cohesion_pa><young_modulus_pa>1e6</young_modulus_pa>"
      "<poisson>0.3</poisson><tool_friction_angle_deg>20</tool_friction_angle_deg>"
      "<adhesion_pa>0</adhesion_pa><bekker_kc_n_per_m_n1>5270</bekker_kc_n_per_m_n1>"
      "<bekker_kphi_n_per_m_n2>1515040</bekker_kphi_n_per_m_n2><bekker_n>0.7</bekker_n>"
      "<janosi_k_m>0.02</janosi_k_m><compaction_pressure_pa>10000</compaction_pressure_pa>"
      "<color>0.5 0.4 0.3</color></navvy:soil>"
      "<navvy:ground><size_m>18 12</size_m><origin_m>-6 -6</origin_m><depth_m>2</depth_m>"
      "<layer><soil>loam</soil></layer><patch><min_m>4.5 -2</min_m><max_m>8 2</max_m>"
      "<layer><soil>loose</soil><thickness_m>0.4</thickness_m></layer>"
      "<layer><soil>loam</soil></layer></patch></navvy:ground>"
      "<navvy:solver><cell_m>0.15</cell_m></navvy:solver>"
      "<include><uri>model://ex180_tracked</uri><name>digger</name><navvy:program><compact>"
      "<polygon_m>5.8 -0.45 6.7 -0.45 6.7 0.45 5.8 0.45</polygon_m><with>bucket</with>"
      "<passes>1</passes></compact></navvy:program></include>"
      "<navvy:recording><duration_s>60</duration_s><render>false</render>"
      "<settle_s>0.5</settle_s></navvy:recording></world></sdf>",
      navvy::source_dir() + "/scenarios/press.sdf", control::step_kinds());
}

double value(const control::StepReport& step, const std::string& name) {
  for (const control::Measurement& one : step.measurements)
    if (one.name == name) return one.value;
  ADD_FAILURE() << "no " << name;
  return NAN;
}

TEST(BucketPress, MakesLooseSoilDenserAndDoesNotLiftTheMachine) {
  device::Device device;
  const scene::Scene description = loose_patch();
  Session session(description, device);
  std::vector<char> middle;
  double most_tilt = 0, least_margin = 10;
  while (!session.done()) {
    session.step();
    const vehicle::Stability stands = session.world().machines().at(0).stability();
    most_tilt = std::max(most_tilt, stands.tilt);
    least_margin = std::min(least_margin, stands.loaded_margin);
    if (middle.empty() && session.phase(0) == "lift") middle = session.snapshot();
  }
  const ProgramReport report = session.programs().at(0);
  ASSERT_TRUE(session.complete()) << report.last().reason;
  const double before = value(report.last(), "density_before_kg_m3"),
               after = value(report.last(), "density_kg_m3");
  print_value("density before the press [kg/m3]", before, "1250", "loose loam");
  print_value("density after it [kg/m3]", after, "> 1.03 of it", "of the uppermost 0.3 m");
  print_value("settled by [m]", value(report.last(), "settled_m"), "> 0.01", "");
  print_value("mean of the greatest forces [N]", value(report.last(), "press_n"), "> 10000", "");
  print_value("largest tilt [deg]", degrees(most_tilt), "< 2", "");
  print_value("least margin of the centre of pressure [m]", least_margin, "> 0", "");
  EXPECT_NEAR(before, 1250, 1);
  EXPECT_GT(after, 1.03 * before);
  EXPECT_GT(value(report.last(), "settled_m"), 0.01);
  EXPECT_GT(value(report.last(), "press_n"), 10e3);
  EXPECT_EQ(value(report.last(), "places_missed"), 0);
  EXPECT_LT(most_tilt, radians(2));
  EXPECT_GT(least_margin, 0);
  EXPECT_EQ(session.world().soil().mass_ledger().error, 0);
  // From a snapshot in the middle it goes on as it did.
  Session resumed(description, device);
  resumed.restore(middle);
  while (!resumed.done()) resumed.step();
  EXPECT_EQ(resumed.state_hash(), session.state_hash());
}

}  // namespace
}  // namespace navvy::session
