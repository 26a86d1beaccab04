// SPDX-License-Identifier: Apache-2.0
// Scores of real worlds: masses close against the ledger, designs are compared, drives measured.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "control/step_kinds.h"
#include "core/saved_state.h"
#include "device/device.h"
#include "paths.h"
#include "record/score.h"
#include "scene_io/loader.h"
#include "session/session.h"

namespace navvy::session {
namespace {

class ScoreTest : public testing::Test {
 protected:
  static scene::Scene site(const std::string& content) {
    return scene_io::load_scene_from_string(
        "<sdf version=\"1.9\" xmlns:navvy=\"navvy\"><world name=\"s\"><navvy:soil ref=\"loam\"/>"
        "<navvy:ground><size_m>12 10</size_m></navvy:ground><navvy:solver><cell_m>0.1</cell_m>"
        "</navvy:solver>" +
            content +
            "<navvy:recording><duration_s>20</duration_s><settle_s>0.1</settle_s><render>false"
            "</render></navvy:recording></world></sdf>",
        navvy::source_dir() + "/scenarios/s.sdf", control::step_kinds());
  }
  device::Device device_;
};

TEST_F(ScoreTest, ClosesAgainstTheLedgerWhileABucketDigs) {
  scene_io::Overrides overrides;
  overrides.render = false;
  overrides.set.push_back(scene_io::parse_setting("solver.cell_m=0.2"));
  Session session(scene_io::load_scene(navvy::source_dir() + "/scenarios/bucket_path.sdf",
                                       control::step_kinds(), overrides),
                  device_);
  while (session.world().time() < 2.2) session.step();
  ASSERT_GT(session.world().soil().counts().particles, 50);
  const record::Score score = record::measure_score(session);
  EXPECT_EQ(score.balance_error, 0);
  EXPECT_GT(score.outside.lost, 0);
  EXPECT_EQ(score.inside.lost, 0) << "without a design nothing is inside";
  EXPECT_FALSE(score.shape.has_value());
}

TEST_F(ScoreTest, ComparesUntouchedGroundWithAPit) {
  // A floor of 2 x 1 m, 0.5 m deep, with sides of 1:1.
  const scene::Scene scene = site(
      "<navvy:design><area><polygon_m>1 1 3 1 3 2 1 2</polygon_m><depth_m>0.5</depth_m>"
      "<batter_deg>45</batter_deg></area></navvy:design>"
      "<navvy:goals><coverage>0.5</coverage><over_dig_max_m>0.01</over_dig_max_m></navvy:goals>");
  const Session session(scene, device_);
  const record::Score score = record::measure_score(session);
  ASSERT_TRUE(score.shape.has_value());
  // Floor, prisms along the edges, quarter cones at the corners; columns of 0.1 m.
  const double volume = 1.0 + 6 * 0.125 + kPi * 0.125 / 3;
  EXPECT_NEAR(score.shape->design_cut, volume, 0.02 * volume);
  EXPECT_EQ(score.shape->completion, 0);
  EXPECT_NEAR(score.shape->volume_error, -1, 1e-9);
  EXPECT_EQ(score.shape->over_max, 0);
  EXPECT_NEAR(score.shape->under_max, 0.5, 1e-6);
  ASSERT_TRUE(score.shape->design_batter.has_value());
  EXPECT_NEAR(*score.shape->design_batter, radians(45), radians(1));
  EXPECT_NEAR(*score.shape->batter, 0, 1e-6) << "level ground has no sides";
  const std::vector<record::GoalResult> goals =
      record::judge(score, session.world().description().goals);
  ASSERT_EQ(goals.size(), 2u);
  EXPECT_FALSE(goals[0].met);
  EXPECT_TRUE(goals[1].met);
  EXPECT_EQ(goals[1].text(), "over_dig_max_m is 0, wanted is at most 0.01");
}

TEST_F(ScoreTest, MissesAGoalOfSidesWhoseAngleNoColumnShows) {
  // Vertical sides cover no column.
  const scene::Scene scene = site(
      "<navvy:design><area><polygon_m>1 1 3 1 3 2 1 2</polygon_m><depth_m>0.5</depth_m>"
      "<batter_deg>90</batter_deg></area></navvy:design>"
      "<navvy:goals><batter_error_deg>5</batter_error_deg></navvy:goals>");
  const Session session(scene, device_);
  const record::Score score = record::measure_score(session);
  ASSERT_TRUE(score.shape.has_value());
  EXPECT_FALSE(score.shape->batter.has_value());
  const std::vector<record::GoalResult> goals =
      record::judge(score, session.world().description().goals);
  ASSERT_EQ(goals.size(), 1u);
  EXPECT_FALSE(goals[0].met);
  EXPECT_FALSE(goals[0].value.has_value());
  EXPECT_EQ(goals[0].text(),
            "batter_error_deg cannot be measured, as fewer than 20 columns show the angle of the "
            "sides, wanted is at most 5");
}

TEST_F(ScoreTest, JudgesSidesWhoseAngleIsKnown) {
  // Untouched ground where sides of 45 deg are commanded.
  const scene::Scene scene = site(
      "<navvy:design><area><polygon_m>1 1 3 1 3 2 1 2</polygon_m><depth_m>0.5</depth_m>"
      "<batter_deg>45</batter_deg></area></navvy:design>"
      "<navvy:goals><batter_error_deg>5</batter_error_deg></navvy:goals>");
  const Session session(scene, device_);
  const std::vector<record::GoalResult> goals =
      record::judge(record::measure_score(session), session.world().description().goals);
  ASSERT_EQ(goals.size(), 1u);
  EXPECT_FALSE(goals[0].met);
  ASSERT_TRUE(goals[0].value.has_value());
  EXPECT_NEAR(*goals[0].value, 45, 1);
}

TEST_F(ScoreTest, MeasuresTheDistanceDrivenAndKeepsItInSnapshots) {
  const scene::Scene scene = site(
      "<include><uri>model://robot</uri><pose>-3 0 0 0 0 0</pose><navvy:program><drive_to>"
      "<target_m>1 0</target_m><speed_m_per_s>1</speed_m_per_s></drive_to></navvy:program>"
      "</include>");
  Session session(scene, device_);
  while (!session.done()) session.step();
  const double driven = session.travel().machines()[0].distance;
  EXPECT_NEAR(driven, 4, 0.2);  // its tolerance, and a chord
  Session resumed(scene, device_);
  load_saved(saved(session), resumed);
  EXPECT_EQ(resumed.travel().machines()[0].distance, driven);
  EXPECT_EQ(resumed.state_hash(), session.state_hash());
  const record::Score score = record::measure_score(session);
  ASSERT_EQ(score.machines.size(), 1u);
  EXPECT_EQ(score.machines[0].cycles, 0);
  EXPECT_GT(score.work_time, 3);
}

TEST(Spread, IsTheStandardDeviationOfTheSample) {
  const record::Spread one = record::spread_of({2, 4, 6});
  EXPECT_EQ(one.count, 3);
  EXPECT_DOUBLE_EQ(one.mean, 4);
  EXPECT_DOUBLE_EQ(one.spread, 2);
  EXPECT_EQ(record::spread_of({}).count, 0);
}

}  // namespace
}  // namespace navvy::session
