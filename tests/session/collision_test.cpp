// SPDX-License-Identifier: Apache-2.0
// Collisions of machines during a run.
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

std::string robot(const std::string& name, const std::string& pose, const std::string& more) {
  return "<include><uri>model://robot</uri><name>" + name + "</name><pose>" + pose + "</pose>" +
         more + "</include>";
}
std::string drive_to(const std::string& target) {
  return "<navvy:program><drive_to><target_m>" + target +
         "</target_m><speed_m_per_s>1</speed_m_per_s></drive_to></navvy:program>";
}

class Collisions : public testing::Test {
 protected:
  void run(const std::string& machines) {
    session_ = std::make_unique<Session>(
        scene_io::load_scene_from_string(
            "<sdf version=\"1.9\" xmlns:navvy=\"navvy\"><world name=\"c\">"
            "<navvy:soil ref=\"gravel\"/><navvy:ground><size_m>12 10</size_m></navvy:ground>"
            "<navvy:solver><cell_m>0.2</cell_m></navvy:solver>" +
                machines +
                "<navvy:recording><duration_s>12</duration_s><settle_s>0.1</settle_s>"
                "<render>false</render></navvy:recording></world></sdf>",
            navvy::source_dir() + "/scenarios/c.sdf", control::step_kinds()),
        device_);
    while (!session_->done()) session_->step();
  }
  std::string name(int machine) const { return session_->world().machines().at(machine).name(); }

  device::Device device_;
  std::unique_ptr<Session> session_;
};

TEST_F(Collisions, OfADriveIntoAWallHaveForceAndDepth) {
  const LogLines log;
  run(robot("robot", "-3 0 0 0 0 0", drive_to("3 0")) + kWall);
  ASSERT_FALSE(session_->collisions().collisions().empty());
  const Collision& first = session_->collisions().collisions().front();
  EXPECT_EQ(name(first.machine), "robot");
  EXPECT_EQ(name(first.other_machine), "wall");
  EXPECT_GT(first.start, 1.5);
  EXPECT_LT(first.start, 6);
  EXPECT_GE(first.end, first.start);
  EXPECT_GT(first.force_peak, 0);
  EXPECT_LT(first.depth_peak, 0.05);
  const std::string text = log.text();
  const std::size_t at = text.find("collision: 'robot' (");
  ASSERT_NE(at, std::string::npos) << text;
  EXPECT_EQ(text.find("collision: ", at + 1), std::string::npos) << "once per pair:\n" << text;
  // A loaded session has the same list.
  const std::vector<char> state = saved(*session_);
  load_saved(state, *session_);
  EXPECT_EQ(session_->collisions().collisions().size(),
            static_cast<std::size_t>(session_->collisions().count()));
}

TEST_F(Collisions, OfAKinematicMachineThatPassesAWallAreListed) {
  run(robot("robot", "-3 0 0 0 0 0", "<navvy:physics>kinematic</navvy:physics>" + drive_to("3 0")) +
      kWall);
  ASSERT_FALSE(session_->collisions().collisions().empty());
  const Collision& first = session_->collisions().collisions().front();
  EXPECT_EQ(name(first.machine), "robot");
  EXPECT_EQ(name(first.other_machine), "wall");
  EXPECT_EQ(first.force_peak, 0);
  EXPECT_GT(first.depth_peak, 0.05);
  EXPECT_GT(first.end - first.start, 0.5) << "it passes through the whole wall";
}

TEST_F(Collisions, AreNoneOfMachinesThatKeepApart) {
  run(robot("one", "-3 2 0 0 0 0", drive_to("-1.5 2")) + robot("two", "-3 -2 0 0 0 0", "") + kWall);
  for (const Collision& one : session_->collisions().collisions())
    ADD_FAILURE() << name(one.machine) << " and " << name(one.other_machine);
  EXPECT_EQ(session_->collisions().count(), 0);
}

}  // namespace
}  // namespace navvy::session
