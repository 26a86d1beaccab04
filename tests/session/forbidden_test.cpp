// SPDX-License-Identifier: Apache-2.0
// Events that a scene forbids end a run as failed.
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "control/step_kinds.h"
#include "core/saved_state.h"
#include "device/device.h"
#include "log_lines.h"
#include "paths.h"
#include "scene_io/loader.h"
#include "session/session.h"

namespace navvy::session {
namespace {

const char* const kWall =
    "<model name=\"wall\"><static>true</static><pose>0 0 0 0 0 0</pose><link name=\"b\">"
    "<pose>0 0 0.3 0 0 0</pose><collision name=\"c\"><geometry><box><size>0.3 9 0.6</size></box>"
    "</geometry></collision></link></model>";
const char* const kSteep = "<size_m>30 10</size_m><slope><angle_deg>-35</angle_deg></slope>";

std::string machine(const std::string& model, const std::string& pose, const std::string& more) {
  return "<include><uri>model://" + model + "</uri><name>machine</name><pose>" + pose + "</pose>" +
         more + "</include>";
}
std::string program(const std::string& steps) {
  return "<navvy:program>" + steps + "</navvy:program>";
}

class ForbiddenEvents : public testing::Test {
 protected:
  static scene::Scene load(const std::string& ground, const std::string& machines,
                           const std::string& forbid, const std::string& duration = "12") {
    return scene_io::load_scene_from_string(
        "<sdf version=\"1.9\" xmlns:navvy=\"navvy\"><world name=\"f\">"
        "<navvy:soil ref=\"loam\"/><navvy:ground>" +
            ground + "</navvy:ground><navvy:solver><cell_m>0.2</cell_m></navvy:solver>" + machines +
            (forbid.empty() ? "" : "<navvy:forbid>" + forbid + "</navvy:forbid>") +
            "<navvy:recording><duration_s>" + duration +
            "</duration_s><settle_s>0.1</settle_s><render>false</render></navvy:recording></world>"
            "</sdf>",
        navvy::source_dir() + "/scenarios/f.sdf", control::step_kinds());
  }
  /// Runs a scene to its end; the machine's speed is an input if it is not 0.
  void run(const std::string& ground, const std::string& machines, const std::string& forbid,
           double speed = 0) {
    session_ = std::make_unique<Session>(load(ground, machines, forbid), device_);
    if (speed != 0) session_->set("machine/drive/speed", speed);
    while (!session_->done()) session_->step();
  }
  /// Expects an event at which the run ended, with `fragment` in its reason.
  void expect(const std::string& event, const std::string& fragment) {
    ASSERT_TRUE(session_->forbidden().has_value());
    EXPECT_EQ(session_->forbidden()->event, event);
    EXPECT_NE(session_->forbidden()->reason.find(fragment), std::string::npos)
        << session_->forbidden()->reason;
    EXPECT_FALSE(session_->complete());
    EXPECT_LT(session_->world().time(), 11.9) << "the event ends the run";
    EXPECT_NEAR(session_->forbidden()->time, session_->world().time(), 1e-9);
  }

  device::Device device_;
  std::unique_ptr<Session> session_;
};

const char* const kIntoWall =
    "<drive_to><target_m>3 0</target_m><speed_m_per_s>1</speed_m_per_s></drive_to>";

TEST_F(ForbiddenEvents, ACollisionEndsTheRun) {
  const LogLines log;
  run("<size_m>12 10</size_m>", machine("robot", "-3 0 0 0 0 0", program(kIntoWall)) + kWall,
      "<collision>true</collision>");
  expect("collision", "'machine' (");
  EXPECT_NE(session_->forbidden()->reason.find("'wall' (b)"), std::string::npos);
  EXPECT_NE(log.text().find("forbidden event collision: 'machine' ("), std::string::npos)
      << log.text();
}

TEST_F(ForbiddenEvents, ACollisionThatIsNotForbiddenDoesNotEndTheRun) {
  run("<size_m>12 10</size_m>", machine("robot", "-3 0 0 0 0 0", program(kIntoWall)) + kWall,
      "<off_site>true</off_site><tip>true</tip><buried>true</buried>");
  EXPECT_FALSE(session_->forbidden().has_value());
  EXPECT_GT(session_->collisions().count(), 0);
}

TEST_F(ForbiddenEvents, AKinematicMachineThatPassesAWallEndsTheRun) {
  run("<size_m>12 10</size_m>",
      machine("robot", "-3 0 0 0 0 0",
              "<navvy:physics>kinematic</navvy:physics>" + program(kIntoWall)) +
          kWall,
      "<collision>true</collision>");
  expect("collision", "'wall' (b)");
}

TEST_F(ForbiddenEvents, AMachineThatInputsDriveOffTheSiteEndsTheRun) {
  run("<size_m>12 10</size_m>", machine("robot", "4 0 0 0 0 0", ""), "<off_site>true</off_site>",
      1);
  expect("off_site", "the base of 'machine' is beyond the border of the site");
  EXPECT_NEAR(session_->world().machines().at(0).link(0).pose().translation().x(), 6, 0.3);
}

TEST_F(ForbiddenEvents, AMachineThatTipsEndsTheRun) {
  const std::string across =
      "<size_m>30 20</size_m><slope><angle_deg>30</angle_deg><yaw_deg>90</yaw_deg></slope>";
  run(across, machine("ew180", "0 0 0 0 0 0", ""), "<tip>true</tip>");
  expect("tip", "outside its support polygon");
  run(across, machine("ew180", "0 0 0 0 0 0", program("<wait><duration_s>10</duration_s></wait>")),
      "<tip>true</tip>");
  expect("tip", "'machine': ");
}

TEST_F(ForbiddenEvents, AMachineThatIsBuriedIsNoted) {
  const LogLines log;
  session_ = std::make_unique<Session>(
      load("<size_m>12 10</size_m>", machine("robot", "0 0 0 0 0 0", ""), "<buried>true</buried>"),
      device_);
  ForbiddenWatch watch(session_->world());
  EXPECT_TRUE(watch.needs_states());
  watch.look(session_->world(), {}, {{0, control::StepState::kTipped, "it tilts"}}, false);
  EXPECT_FALSE(watch.event().has_value()) << "only what is forbidden counts";
  watch.look(session_->world(), {}, {{0, control::StepState::kBuried, "soil is over it"}}, false);
  ASSERT_TRUE(watch.event().has_value());
  EXPECT_EQ(watch.event()->text(), "forbidden event buried: 'machine': soil is over it (0.00 s)");
  EXPECT_NE(log.text().find(watch.event()->text()), std::string::npos) << log.text();
}

/// Returns a dumper that tips 2.4 t behind itself.
std::string tipping() {
  return machine("dumper", "0 0 0 0 0 0",
                 "<navvy:load><mass_kg>2400</mass_kg></navvy:load>" +
                     program("<tip><angle_deg>60</angle_deg><hold_s>3</hold_s></tip>"));
}

TEST_F(ForbiddenEvents, SoilOutsideTheAreasEndsTheRun) {
  run("<size_m>24 20</size_m>", tipping(),
      "<spill_outside><mass_kg>200</mass_kg><area><polygon_m>4 -3 8 -3 8 3 4 3</polygon_m></area>"
      "</spill_outside>");
  expect("spill_outside", "kg of soil rest outside the areas");
}

TEST_F(ForbiddenEvents, SoilWithinTheAreasDoesNotEndTheRun) {
  const std::string within =
      "<spill_outside><mass_kg>200</mass_kg><area><polygon_m>4 -3 8 -3 8 3 4 3</polygon_m></area>"
      "<area><polygon_m>-9 -5 2 -5 2 5 -9 5</polygon_m></area></spill_outside>";
  run("<size_m>24 20</size_m>", tipping(), within);
  EXPECT_FALSE(session_->forbidden().has_value()) << session_->forbidden()->text();
  EXPECT_FALSE(session_->fell_short());
  const std::string hash = session_->state_hash();
  // What is forbidden and does not occur changes nothing.
  run("<size_m>24 20</size_m>", tipping(), "");
  EXPECT_EQ(session_->state_hash(), hash);
}

TEST_F(ForbiddenEvents, SoilThatLeavesTheSiteEndsTheRun) {
  // The bed reaches beyond the border.
  run("<size_m>8 8</size_m>",
      machine("dumper", "-2 0 0 0 0 0",
              "<navvy:load><mass_kg>2400</mass_kg></navvy:load>" +
                  program("<tip><angle_deg>60</angle_deg><hold_s>3</hold_s></tip>")),
      "<spill_outside><mass_kg>50</mass_kg></spill_outside>");
  expect("spill_outside", "have left the site");
}

TEST_F(ForbiddenEvents, SurviveASnapshotAndLetASceneWithoutThemContinue) {
  const std::string scene = machine("robot", "-3 0 0 0 0 0", program(kIntoWall)) + kWall;
  run("<size_m>12 10</size_m>", scene, "<collision>true</collision>");
  expect("collision", "'wall' (b)");
  const std::vector<char> state = saved(*session_);
  Session same(load("<size_m>12 10</size_m>", scene, "<collision>true</collision>"), device_);
  load_saved(state, same);
  EXPECT_TRUE(same.done());
  EXPECT_EQ(same.forbidden()->text(), session_->forbidden()->text());
  Session lenient(load("<size_m>12 10</size_m>", scene, ""), device_);
  load_saved(state, lenient);
  EXPECT_FALSE(lenient.done());
  EXPECT_FALSE(lenient.forbidden().has_value());
  // The scene forbids something, but not what had happened.
  Session other(load("<size_m>12 10</size_m>", scene, "<tip>true</tip>"), device_);
  load_saved(state, other);
  EXPECT_FALSE(other.done());
  EXPECT_FALSE(other.forbidden().has_value());
}

TEST_F(ForbiddenEvents, ACollisionFromBeforeARunWasResumedDoesNotEndIt) {
  const std::string scene =
      machine("robot", "-3 0 0 0 0 0",
              "<navvy:physics>kinematic</navvy:physics>" + program(kIntoWall)) +
      kWall;
  run("<size_m>12 10</size_m>", scene, "");
  ASSERT_GT(session_->collisions().count(), 0);
  ASSERT_GT(session_->world().machines().at(0).link(0).pose().translation().x(), 2)
      << "the robot is behind the wall";
  Session resumed(load("<size_m>12 10</size_m>", scene, "<collision>true</collision>"), device_);
  load_saved(saved(*session_), resumed);
  for (int i = 0; i < 3; ++i) resumed.step();
  EXPECT_GT(resumed.collisions().count(), 0);
  EXPECT_FALSE(resumed.forbidden().has_value()) << resumed.forbidden()->text();
}

TEST_F(ForbiddenEvents, ACollisionThatLastsWhenARunIsResumedEndsIt) {
  const std::string scene =
      machine("robot", "-3 0 0 0 0 0",
              "<navvy:physics>kinematic</navvy:physics>" + program(kIntoWall)) +
      kWall;
  Session before(load("<size_m>12 10</size_m>", scene, ""), device_);
  while (before.collisions().count() == 0 && !before.done()) before.step();
  session_ = std::make_unique<Session>(
      load("<size_m>12 10</size_m>", scene, "<collision>true</collision>"), device_);
  load_saved(saved(before), *session_);
  EXPECT_FALSE(session_->forbidden().has_value());
  while (!session_->done()) session_->step();
  expect("collision", "'wall' (b)");
  EXPECT_NEAR(session_->forbidden()->time, before.world().time() + before.world().dt(), 1e-9);
}

}  // namespace
}  // namespace navvy::session
