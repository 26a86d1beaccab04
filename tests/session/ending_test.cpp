// SPDX-License-Identifier: Apache-2.0
// Reports about machines that do not reach the targets of their programs.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "control/step_kinds.h"
#include "core/saved_state.h"
#include "device/device.h"
#include "log_lines.h"
#include "paths.h"
#include "scene_io/loader.h"
#include "session/session.h"

namespace navvy::session {
namespace {

using control::StepState;

scene::Scene load(const std::string& ground, const std::string& machines) {
  const std::string text =
      "<sdf version=\"1.9\" xmlns:navvy=\"navvy\"><world name=\"ends\"><navvy:soil "
      "ref=\"loam\"/>\n<navvy:ground>" +
      ground + "</navvy:ground><navvy:solver><cell_m>0.2</cell_m></navvy:solver>\n" + machines +
      "<navvy:recording><duration_s>20</duration_s><settle_s>0.1</settle_s><render>false</render></"
      "navvy:recording>" +
      "</world></sdf>";
  return scene_io::load_scene_from_string(text, navvy::source_dir() + "/scenarios/ends.sdf",
                                          control::step_kinds());
}

std::string machine(const std::string& model, const std::string& name, const std::string& pose,
                    const std::string& program) {
  return "<include><uri>model://" + model + "</uri><name>" + name + "</name><pose>" + pose +
         "</pose>" + (program.empty() ? "" : "<navvy:program>" + program + "</navvy:program>") +
         "</include>\n";
}

TEST(SessionEnd, OfATruckThatRunsIntoAParkedMachineIsBlocked) {
  device::Device device;
  Session session(
      load(
          "<size_m>30 12</size_m>",
          machine("ew180", "parked", "3 0 0 0 0 0", "") +
              machine(
                  "dumper", "truck", "-5 0 0 0 0 0",
                  "<drive_to><target_m>12 0</target_m><speed_m_per_s>1.5</speed_m_per_s></drive_to>"
                  "<tip><angle_deg>60</angle_deg></tip>")),
      device);
  while (!session.done()) session.step();
  EXPECT_FALSE(session.complete());
  EXPECT_TRUE(session.fell_short());
  const ProgramReport report = session.programs().at(0);
  EXPECT_EQ(report.machine, 1);
  EXPECT_EQ(report.steps, 2);
  ASSERT_EQ(report.list.size(), 1u) << "it does not tip its bed on the way";
  EXPECT_EQ(report.last().state, StepState::kBlocked);
  EXPECT_NE(report.last().reason.find("something holds it"), std::string::npos)
      << report.last().reason;
  // Its final position, and 5 s after it stopped.
  EXPECT_LT(report.last().place.x(), 3);
  EXPECT_GT(report.last().place.x(), -5);
  EXPECT_LT(report.last().end, 14);
  EXPECT_EQ(session.phase(1), "blocked");
  EXPECT_TRUE(session.world().machines().at("truck").drive().brake);
}

TEST(SessionEnd, OfAnExcavatorThatRollsOverIsTippedWhileAnotherContinues) {
  // Across a slope of 30 deg the tyres' compliance tips it; straight up it remains upright.
  device::Device device;
  const auto make = [&] {
    return std::make_unique<Session>(
        load(
            "<size_m>36 20</size_m><slope><angle_deg>30</angle_deg><yaw_deg>90</yaw_deg></slope>",
            machine("ew180", "across", "-8 0 0 0 0 0", "<wait><duration_s>10</duration_s></wait>") +
                machine("ew180", "upwards", "8 -4 0 0 0 1.5707963",
                        "<wait><duration_s>1</duration_s></wait>")),
        device);
  };
  const auto session = make();
  while (session->phase(0) != "tipped" && !session->done()) session->step();
  const std::vector<char> bytes = saved(*session);
  while (!session->done()) session->step();
  EXPECT_FALSE(session->complete());
  const ProgramReport across = session->programs().at(0), upwards = session->programs().at(1);
  EXPECT_EQ(across.last().state, StepState::kTipped);
  EXPECT_LT(across.last().end, 2);
  EXPECT_NE(across.last().reason.find("outside its support polygon"), std::string::npos)
      << across.last().reason;
  EXPECT_EQ(upwards.last().state, StepState::kDone) << upwards.last().reason;
  EXPECT_GT(upwards.last().end, across.last().end);
  // No false alarm: the machine reported as tipped has rolled onto its side.
  EXPECT_GT(session->world().machines().at("across").stability().tilt, radians(40));
  // The report survives a snapshot.
  const auto resumed = make();
  load_saved(bytes, *resumed);
  while (!resumed->done()) resumed->step();
  EXPECT_EQ(resumed->programs().at(0).last().reason, across.last().reason);
  EXPECT_EQ(resumed->state_hash(), session->state_hash());
}

TEST(SessionEnd, OfUncontrolledMachinesReportsTheirFall) {
  // One was never driven, one is controlled by inputs: both roll over across 30 deg, while a third
  // one stays upright.
  device::Device device;
  const auto make = [&] {
    return std::make_unique<Session>(
        load("<size_m>50 20</size_m><slope><angle_deg>30</angle_deg><yaw_deg>90</yaw_deg></slope>",
             machine("ew180", "parked", "-15 0 0 0 0 0", "") +
                 machine("ew180", "taken", "0 0 0 0 0 0",
                         "<wait><duration_s>10</duration_s></wait>") +
                 machine("ew180", "upwards", "15 -4 0 0 0 1.5707963", "")),
        device);
  };
  const auto session = make();
  session->set("taken/drive/speed", 0);
  while (session->world().time() < 3 && session->phase(1) != "tipped") session->step();
  const std::vector<char> bytes = saved(*session);
  while (session->world().time() < 3) session->step();
  EXPECT_TRUE(session->fell_short());
  EXPECT_FALSE(session->complete());
  const std::vector<ProgramReport> reports = session->programs();
  ASSERT_EQ(reports.size(), 2u) << "an upright machine without a program has no report";
  for (const ProgramReport& report : reports) {
    EXPECT_EQ(report.last().state, StepState::kTipped);
    EXPECT_EQ(report.last().step, 0);
    EXPECT_GT(report.last().end, 0);
    EXPECT_LT(report.last().end, 2.5);
    EXPECT_NE(report.last().reason.find("outside its support polygon"), std::string::npos)
        << report.last().reason;
  }
  EXPECT_EQ(reports[0].machine, 0);
  EXPECT_EQ(reports[0].steps, 0);
  EXPECT_EQ(reports[0].last().element, "idle");
  EXPECT_EQ(reports[1].machine, 1);
  EXPECT_TRUE(reports[1].taken);
  EXPECT_EQ(reports[1].last().element, "inputs");
  EXPECT_EQ(session->phase(0), "tipped");
  EXPECT_EQ(session->phase(2), "idle");
  // Tilt and state are outputs.
  EXPECT_GT(session->world().outputs().get("parked/stability/tilt"), radians(40));
  EXPECT_GT(session->world().outputs().get("upwards/stability/margin"), 0.1);
  EXPECT_NEAR(session->world().outputs().get("upwards/stability/tilt"), radians(30), radians(4));
  EXPECT_NE(report_line(reports[0], "parked").find("'parked' (idle): tipped: "), std::string::npos)
      << report_line(reports[0], "parked");
  // The report of the fall survives a snapshot and is logged once.
  const auto resumed = make();
  load_saved(bytes, *resumed);
  while (resumed->world().time() < 3) resumed->step();
  EXPECT_EQ(resumed->programs().at(1).last().reason, reports[1].last().reason);
  EXPECT_EQ(resumed->programs().at(1).list.size(), reports[1].list.size());
  EXPECT_EQ(resumed->state_hash(), session->state_hash());
}

TEST(SessionBorder, AMachineThatLeavesTheSiteIsReportedOnce) {
  const LogLines log;
  const auto logged = [&] {
    std::vector<std::string> out;
    for (const std::string& line : log.lines())
      if (line.find("has left the site") != std::string::npos) out.push_back(line);
    return out;
  };
  device::Device device;
  Session session(
      load("<size_m>16 8</size_m>", machine("dumper", "truck", "2 0 0 0 0 0", "") +
                                        machine("dumper", "parked", "-4 0 0 0 0 0", "")),
      device);
  session.set("truck/drive/speed", 2);
  const auto x = [&] { return session.world().machines().at(0).link(0).pose().translation().x(); };
  session.step();
  EXPECT_TRUE(logged().empty()) << "both are on the site";
  while (x() < 9 && session.world().time() < 10) session.step();
  ASSERT_GE(x(), 9);
  ASSERT_EQ(logged().size(), 1u);
  EXPECT_NE(logged()[0].find("'truck'"), std::string::npos) << logged()[0];
  EXPECT_NE(logged()[0].find("size_m"), std::string::npos) << logged()[0];
}

TEST(SessionEnd, WithoutSettlingIsRightAfterTheProgram) {
  device::Device device;
  scene::Scene scene =
      load("<size_m>16 8</size_m>",
           machine("dumper", "truck", "0 0 0 0 0 0", "<wait><duration_s>0.5</duration_s></wait>"));
  scene.recording.settle = 0;
  Session session(std::move(scene), device);
  while (!session.done()) session.step();
  EXPECT_TRUE(session.complete());
  EXPECT_NEAR(session.world().time(), 0.5, 0.05);
}

const char* const kSteep = "<size_m>30 10</size_m><slope><angle_deg>-35</angle_deg></slope>";

TEST(SessionEnd, OfAMachineThatSlidesWhileItWaitsIsMoved) {
  device::Device device;
  Session session(load(kSteep, machine("robot", "robot", "-3 0 0 0 0 0",
                                       "<wait><duration_s>2</duration_s></wait>")),
                  device);
  while (!session.done()) session.step();
  EXPECT_TRUE(session.fell_short());
  const ProgramReport report = session.programs().at(0);
  EXPECT_EQ(report.last().state, StepState::kMoved) << report.last().reason;
  EXPECT_NE(report.last().reason.find("it slid or was pushed 0.5"), std::string::npos)
      << report.last().reason;
  EXPECT_EQ(session.phase(0), "moved");
}

TEST(SessionEnd, OfAMachineThatLeavesTheSiteIsOffSite) {
  device::Device device;
  // It cannot stop on this slope: the border is that of 152 columns of 0.2 m.
  Session session(load(kSteep, machine("robot", "robot", "8 0 0 0 0 0",
                                       "<drive_to><target_m>14 0</target_m>"
                                       "<speed_m_per_s>3</speed_m_per_s></drive_to>"
                                       "<drive_to><target_m>15 0</target_m></drive_to>")),
                  device);
  while (!session.done()) session.step();
  EXPECT_TRUE(session.fell_short());
  const ProgramReport report = session.programs().at(0);
  EXPECT_EQ(report.last().state, StepState::kOffSite) << report.last().reason;
  EXPECT_NE(report.last().reason.find("beyond the border of the site"), std::string::npos);
  EXPECT_GT(report.last().place.x(), 15.2);
  EXPECT_LT(report.last().place.x(), 15.4);
}

TEST(SessionEnd, OfAParkedMachineThatSlidesIsMoved) {
  device::Device device;
  const LogLines log;
  Session session(load(kSteep, machine("robot", "parked", "-8 0 0 0 0 0", "") +
                                   machine("robot", "robot", "0 3 0 0 0 0",
                                           "<wait><duration_s>0.2</duration_s></wait>")),
                  device);
  while (session.phase(0) == "idle" && session.world().time() < 5) session.step();
  EXPECT_EQ(session.phase(0), "moved");
  EXPECT_TRUE(session.fell_short());
  EXPECT_FALSE(session.complete());
  const ProgramReport report = session.programs().at(0);
  EXPECT_EQ(report.last().state, StepState::kMoved);
  EXPECT_EQ(report.last().step, 0);
  EXPECT_NE(report.last().reason.find("it slid or was pushed 0.5"), std::string::npos)
      << report.last().reason;
  EXPECT_NE(log.text().find("'parked' (idle): moved: "), std::string::npos) << log.text();
}

TEST(SessionEnd, OfAParkedMachineThatAnotherPushesIsMoved) {
  device::Device device;
  Session session(
      load("<size_m>20 8</size_m>",
           machine("robot", "parked", "0 0 0 0 0 0", "") +
               "<include><uri>model://robot</uri><name>pusher</name><pose>-2 0 0 0 0 0</pose>"
               "<navvy:physics>kinematic</navvy:physics><navvy:program><drive_to><target_m>3 0"
               "</target_m></drive_to></navvy:program></include>"),
      device);
  while (session.phase(0) == "idle" && session.world().time() < 12) session.step();
  EXPECT_EQ(session.phase(0), "moved");
  EXPECT_GT(session.collisions().count(), 0);
}

TEST(SessionEnd, OfAMachineThatInputsDriveOffTheSiteIsOffSite) {
  device::Device device;
  Session session(load("<size_m>12 8</size_m>", machine("robot", "robot", "3 0 0 0 0 0", "")),
                  device);
  session.set("robot/drive/speed", 1);
  while (session.phase(0) == "idle" && session.world().time() < 8) session.step();
  EXPECT_EQ(session.phase(0), "off_site");
  EXPECT_GT(session.programs().at(0).last().place.x(), 6);
  EXPECT_TRUE(session.fell_short());
}

}  // namespace
}  // namespace navvy::session
