// SPDX-License-Identifier: Apache-2.0
// Bodies that sink into each other during a run.
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

/// Returns a cube with its middle at `height` [m].
std::string cube(const std::string& name, double side, double mass, double height) {
  const double moment = mass * side * side / 6;
  const std::string m = std::to_string(moment), s = std::to_string(side);
  return "<model name=\"" + name + "\"><pose>0 0 " + std::to_string(height) +
         " 0 0 0</pose><navvy:on_ground>false</navvy:on_ground><link name=\"b\"><inertial><mass>" +
         std::to_string(mass) + "</mass><inertia><ixx>" + m + "</ixx><iyy>" + m + "</iyy><izz>" +
         m + "</izz></inertia></inertial><collision name=\"c\"><geometry><box><size>" + s + " " +
         s + " " + s + "</size></box></geometry></collision></link></model>";
}

class Overlaps : public testing::Test {
 protected:
  static scene::Scene load(const std::string& machines) {
    return scene_io::load_scene_from_string(
        "<sdf version=\"1.9\" xmlns:navvy=\"navvy\"><world name=\"o\">"
        "<navvy:soil ref=\"gravel\"/><navvy:ground><size_m>6 6</size_m></navvy:ground>"
        // The cubes sink into each other in steps of this length; others may hold them apart.
        "<navvy:solver><cell_m>0.2</cell_m><max_step_s>0.0017</max_step_s></navvy:solver>" +
            machines +
            "<navvy:recording><duration_s>3</duration_s><render>false</render></navvy:recording>"
            "</world></sdf>",
        navvy::source_dir() + "/scenarios/o.sdf", control::step_kinds());
  }
  void run(const std::string& machines) {
    session_ = std::make_unique<Session>(load(machines), device_);
    while (!session_->done()) session_->step();
  }

  device::Device device_;
  std::unique_ptr<Session> session_;
};

TEST_F(Overlaps, OfAHeavyBodyOnALightOneAreListedWithTheirCause) {
  const LogLines log;
  const std::string bodies = cube("light", 0.3, 5, 0.15) + cube("heavy", 1, 5000, 0.8);
  run(bodies);
  ASSERT_FALSE(session_->overlaps().overlaps().empty());
  const BodyOverlap& first = session_->overlaps().overlaps().front();
  EXPECT_EQ(first.machine, 0);
  EXPECT_EQ(first.other_machine, 1);
  EXPECT_GE(first.end - first.start, 0.19);
  EXPECT_GT(first.depth_peak, 0.03);
  EXPECT_NEAR(first.share_peak, first.depth_peak / 0.3, 0.02 * first.share_peak);
  const std::string text = log.text();
  const std::size_t at = text.find("overlap: 'light' (b) and 'heavy' (b) are in each other");
  ASSERT_NE(at, std::string::npos) << text;
  EXPECT_NE(text.find("their masses are 5 and 5e+03 kg, a ratio of 1e+03"), std::string::npos)
      << text;
  EXPECT_EQ(text.find("overlap: ", at + 1), std::string::npos) << "once per pair:\n" << text;
  // The start reported it, too.
  EXPECT_NE(text.find("it rests on 'light' of 5 kg, a ratio of 1e+03"), std::string::npos) << text;
  // A loaded session has the same list.
  Session resumed(load(bodies), device_);
  load_saved(saved(*session_), resumed);
  ASSERT_EQ(resumed.overlaps().count(), session_->overlaps().count());
  EXPECT_EQ(resumed.overlaps().overlaps()[0].depth_peak, first.depth_peak);
}

TEST_F(Overlaps, AreNoneOfBodiesOfLikeMass) {
  const LogLines log;
  run(cube("lower", 0.3, 50, 0.15) + cube("upper", 1, 5000, 0.8));
  EXPECT_EQ(session_->overlaps().count(), 0);
  EXPECT_EQ(log.text().find("it rests on"), std::string::npos) << log.text();
}

}  // namespace
}  // namespace navvy::session
