// SPDX-License-Identifier: Apache-2.0
// Programs that are ordered while a session runs.
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "control/step_kinds.h"
#include "core/error.h"
#include "core/saved_state.h"
#include "device/device.h"
#include "paths.h"
#include "scene_io/loader.h"
#include "scene_io/ordered_program.h"
#include "session/session.h"

namespace navvy::session {
namespace {

using control::StepState;

constexpr const char* kDrive =
    "<drive_to><target_m>-2 0</target_m><speed_m_per_s>1.5</speed_m_per_s></drive_to>";

/// Returns a session in which a dumper with a program of one second stands beside one without.
std::unique_ptr<Session> make_session(device::Device& device, bool orders = true) {
  const std::string text =
      "<sdf version=\"1.9\" xmlns:navvy=\"navvy\"><world name=\"orders\"><navvy:soil "
      "ref=\"loam\"/><navvy:ground><size_m>30 16</size_m></navvy:ground>"
      "<navvy:solver><cell_m>0.2</cell_m></navvy:solver>"
      "<include><uri>model://dumper</uri><name>first</name><pose>-6 0 0 0 0 0</pose>"
      "<navvy:program><wait><duration_s>1</duration_s></wait></navvy:program></include>"
      "<include><uri>model://dumper</uri><name>second</name><pose>-6 5 0 0 0 0</pose></include>"
      "<navvy:recording><duration_s>20</duration_s><settle_s>0.1</settle_s><render>false</render>"
      "</navvy:recording></world></sdf>";
  control::Planners planners;
  if (orders) planners.read_program = scene_io::ordered_program_reader(control::step_kinds());
  return std::make_unique<Session>(
      scene_io::load_scene_from_string(text, source_dir() + "/scenarios/orders.sdf",
                                       control::step_kinds()),
      device, planners);
}

void step_to(Session& session, double time) {
  while (session.world().time() < time) session.step();
}

double x_of(const Session& session, int machine) {
  return session.world().machines().at(machine).link(0).pose().translation().x();
}

/// Returns why an order is refused; empty if it is not.
std::string refused(Session& session, const std::string& machine, const std::string& steps,
                    bool now = false) {
  try {
    session.order(machine, steps, now);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(SessionOrder, FollowsTheProgramAndKeepsItsReports) {
  device::Device device;
  const auto session = make_session(device);
  step_to(*session, 1.2);
  session->order("first", kDrive);
  step_to(*session, 9);
  EXPECT_NEAR(x_of(*session, 0), -2, 0.6);
  EXPECT_FALSE(session->done()) << "another order may follow";
  session->order("first", "<wait><duration_s>0.5</duration_s></wait>");
  step_to(*session, 10);
  const ProgramReport report = session->programs().at(0);
  EXPECT_EQ(report.orders, 2);
  EXPECT_EQ(report.steps, 1);
  ASSERT_EQ(report.list.size(), 3u);
  EXPECT_EQ(report.list[0].element, "wait");
  EXPECT_EQ(report.list[1].element, "drive_to");
  for (const control::StepReport& one : report.list) EXPECT_EQ(one.state, StepState::kDone);
  EXPECT_NEAR(report.list[2].end, 9.5, 0.01);
  EXPECT_TRUE(session->complete());
  EXPECT_FALSE(session->done());
  step_to(*session, 20);
  EXPECT_TRUE(session->done());
}

TEST(SessionOrder, StopsARunningProgramOnlyIfAsked) {
  device::Device device;
  const auto session = make_session(device);
  session->step();
  EXPECT_NE(refused(*session, "first", kDrive).find("busy with step 1 of 1 (wait)"),
            std::string::npos);
  EXPECT_EQ(session->programs().at(0).orders, 0);
  session->order("first", kDrive, true);
  step_to(*session, 2);
  const ProgramReport report = session->programs().at(0);
  ASSERT_EQ(report.list.size(), 2u);
  EXPECT_EQ(report.list[0].state, StepState::kReplaced);
  EXPECT_EQ(report.list[1].state, StepState::kRunning);
  EXPECT_GT(x_of(*session, 0), -5.5);
  EXPECT_FALSE(session->fell_short()) << "a replaced step is no failure of the run";
}

TEST(SessionOrder, DrivesMachinesThatInputsHaveDrivenAndThoseWithoutAProgram) {
  device::Device device;
  const auto session = make_session(device);
  session->set("second/drive/speed", 0.5);
  session->set("first/drive/speed", 0.5);
  step_to(*session, 1);
  EXPECT_EQ(session->phase(0), "inputs");
  EXPECT_EQ(session->phase(1), "idle");
  session->order("first", kDrive);
  session->order("second",
                 "<drive_to><target_m>-2 5</target_m></drive_to><tip><angle_deg>30</angle_deg>"
                 "</tip>");
  session->step();
  EXPECT_EQ(session->phase(0), "drive");
  EXPECT_EQ(session->phase(1), "drive");
  step_to(*session, 10);
  EXPECT_NEAR(x_of(*session, 0), -2, 0.6);
  EXPECT_NEAR(x_of(*session, 1), -2, 0.6);
  // Inputs take it again.
  session->set("first/drive/speed", 0.2);
  EXPECT_EQ(session->phase(0), "inputs");
}

TEST(SessionOrder, StopsWhatInputsHaveSetInMotion) {
  device::Device device;
  const auto session = make_session(device);
  for (const char* input : {"first/drive/speed", "second/drive/speed"}) session->set(input, 1.0);
  step_to(*session, 1.5);
  for (const char* name : {"first", "second"})
    session->order(name, "<wait><duration_s>3</duration_s></wait>");
  step_to(*session, 6);
  for (const ProgramReport& report : session->programs())
    EXPECT_EQ(report.last().state, StepState::kDone) << report.last().reason;
}

TEST(SessionOrder, IsSeenByMachinesThatWaitForIt) {
  device::Device device;
  const auto session = make_session(device);
  // The first machine waits for two steps of the second, which come in two orders.
  session->step();
  session->order("second", "<wait><duration_s>0.5</duration_s></wait>");
  session->order("first", "<wait_for><machine>second</machine><steps>2</steps></wait_for>", true);
  while (session->programs().at(1).last().state != StepState::kDone) session->step();
  session->order("second", "<wait><duration_s>0.5</duration_s></wait>");
  step_to(*session, 0.9);
  EXPECT_EQ(session->phase(0), "wait_for");
  step_to(*session, 1.5);
  EXPECT_EQ(session->programs().at(0).last().state, StepState::kDone);
}

TEST(SessionOrder, IsPartOfSnapshotsAndHashes) {
  device::Device device;
  const auto session = make_session(device);
  session->step();
  const std::vector<char> before = saved(*session);
  session->order("second",
                 "<drive_to><target_m>-2 5</target_m></drive_to><wait><duration_s>1</duration_s>"
                 "</wait>");
  session->order("first", kDrive, true);
  step_to(*session, 3);
  const std::vector<char> bytes = saved(*session);
  const auto resumed = make_session(device);
  load_saved(bytes, *resumed);
  EXPECT_EQ(resumed->state_hash(), session->state_hash());
  step_to(*session, 12);
  step_to(*resumed, 12);
  EXPECT_EQ(resumed->state_hash(), session->state_hash());
  EXPECT_EQ(resumed->programs().size(), 2u);
  EXPECT_EQ(resumed->programs().at(0).list.size(), session->programs().at(0).list.size());
  // And back to a state without orders.
  load_saved(before, *resumed);
  EXPECT_EQ(resumed->programs().size(), 1u);
  EXPECT_EQ(resumed->programs().at(0).orders, 0);
  EXPECT_EQ(resumed->phase(0), "wait");
  EXPECT_EQ(resumed->phase(1), "idle");
  // A reader is needed to load an order.
  const auto deaf = make_session(device, false);
  EXPECT_THROW(load_saved(bytes, *deaf), InputError);
}

TEST(SessionOrder, RefusesFaultyOrdersWithElementAndRemedyAndChangesNothing) {
  device::Device device;
  const auto session = make_session(device);
  step_to(*session, 1.2);
  const std::string hash = session->state_hash();
  struct Case {
    const char *machine, *steps, *part;
  };
  const Case cases[] = {
      {"frist", kDrive, "did you mean 'first'?"},
      {"first", "", "at least one"},
      {"first", "wait", "text is not allowed"},
      {"first", "<wiat/>", "did you mean 'wait'?"},
      {"first", "\n<wait><duration_s>NaN</duration_s></wait>", "order:2: error"},
      {"first", "<drive_to><target_m>900 0</target_m></drive_to>", "order:1: error"},
      {"first", "<wait><duration_s>1</wait>", "well-formed"},
      {"first", "</navvy:program><navvy:program>", "remove the end tag"},
      {"first",
       "<dig><from_m>0 0</from_m><to_m>2 0</to_m><depth_m>1</depth_m>"
       "<dump_at_m>0 4</dump_at_m></dig>",
       "dig needs a machine"},
      {"first", "<wait_for><machine>third</machine></wait_for>", "name of another machine"},
      {"first", "<unhitch><hitch>tow</hitch></unhitch>", "name of a hitch"},
      {"second", "<tip><angle_deg>400</angle_deg></tip>", "angle_deg"},
  };
  for (const Case& one : cases)
    EXPECT_NE(refused(*session, one.machine, one.steps).find(one.part), std::string::npos)
        << one.steps << ": " << refused(*session, one.machine, one.steps);
  EXPECT_EQ(session->state_hash(), hash);
  EXPECT_EQ(session->programs().size(), 1u);
  const auto deaf = make_session(device, false);
  EXPECT_NE(refused(*deaf, "first", kDrive, true).find("no program can be ordered"),
            std::string::npos);
}

}  // namespace
}  // namespace navvy::session
