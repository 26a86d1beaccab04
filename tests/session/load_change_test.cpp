// SPDX-License-Identifier: Apache-2.0
// Steps that empty a bed or a bucket, and what becomes of them when nothing leaves it.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>

#include "control/step_kinds.h"
#include "core/error.h"
#include "device/device.h"
#include "log_lines.h"
#include "paths.h"
#include "scene_io/loader.h"
#include "session/session.h"

namespace navvy::session {
namespace {

class LoadChange : public testing::Test {
 protected:
  static scene::Scene load(const std::string& model, const std::string& more,
                           const std::string& program, const std::string& rest = "") {
    return scene_io::load_scene_from_string(
        "<sdf version=\"1.9\" xmlns:navvy=\"navvy\"><world name=\"load\">"
        "<navvy:soil ref=\"loam\"/><navvy:ground><size_m>24 20</size_m><depth_m>1</depth_m>"
        "</navvy:ground><navvy:solver><cell_m>0.2</cell_m></navvy:solver>"
        "<include><uri>model://" +
            model + "</uri><name>machine</name><pose>0 0 0 0 0 0</pose>" + more +
            "<navvy:program>" + program + "</navvy:program></include>" + rest +
            "<navvy:recording><duration_s>60</duration_s><render>false</render>"
            "<settle_s>0.1</settle_s></navvy:recording></world></sdf>",
        navvy::source_dir() + "/scenarios/load.sdf", control::step_kinds());
  }
  /// Runs a machine with a program on flat loam to the end of the program.
  void run(const std::string& model, const std::string& more, const std::string& program,
           const std::string& rest = "") {
    session_ = std::make_unique<Session>(load(model, more, program, rest), device_);
    while (!session_->done()) session_->step();
  }
  const std::vector<control::StepReport>& steps() {
    report_ = session_->programs().at(0);
    return report_.list;
  }
  static double value(const control::StepReport& step, const std::string& name) {
    for (const control::Measurement& one : step.measurements)
      if (one.name == name) return one.value;
    ADD_FAILURE() << "no " << name;
    return NAN;
  }

  device::Device device_;
  std::unique_ptr<Session> session_;
  ProgramReport report_;
};

TEST_F(LoadChange, TippingAnEmptyBedFallsShort) {
  run("dumper", "", "<tip><angle_deg>60</angle_deg></tip><tip><angle_deg>0</angle_deg></tip>");
  ASSERT_EQ(steps().size(), 1u);
  EXPECT_EQ(steps()[0].state, control::StepState::kStalled);
  EXPECT_EQ(steps()[0].reason, "the bed was empty: nothing could leave it at 60.00 deg");
  EXPECT_TRUE(session_->fell_short());
  EXPECT_EQ(value(steps()[0], "payload_at_start_kg"), 0);
  EXPECT_EQ(value(steps()[0], "tipped_kg"), 0);
}

TEST_F(LoadChange, TippingTooLittleFallsShort) {
  run("dumper", "<navvy:load><mass_kg>2400</mass_kg></navvy:load>",
      "<tip><angle_deg>5</angle_deg></tip><wait><duration_s>1</duration_s></wait>");
  ASSERT_EQ(steps().size(), 1u);
  EXPECT_EQ(steps()[0].state, control::StepState::kStalled);
  EXPECT_NE(steps()[0].reason.find("kg in the bed nothing has left it at 5.00 deg"),
            std::string::npos)
      << steps()[0].reason;
  EXPECT_NEAR(value(steps()[0], "payload_at_start_kg"), 2400, 24);
  EXPECT_LT(std::abs(value(steps()[0], "tipped_kg")), 24);
}

TEST_F(LoadChange, TippingALoadIsDoneAndStatesItsMass) {
  run("dumper", "<navvy:load><mass_kg>2400</mass_kg></navvy:load>",
      "<tip><angle_deg>60</angle_deg><hold_s>2</hold_s></tip><tip><angle_deg>0</angle_deg></tip>");
  ASSERT_EQ(steps().size(), 2u);
  EXPECT_TRUE(session_->complete());
  EXPECT_GT(value(steps()[0], "tipped_kg"), 2000);
  EXPECT_LE(value(steps()[0], "tipped_kg"), value(steps()[0], "payload_at_start_kg"));
  EXPECT_NEAR(value(steps()[0], "tipped_kg"),
              session_->tips().at(0).payload_start - session_->tips().at(0).payload_end, 1e-6);
  // Lowering is no failure, whatever is left in the bed.
  EXPECT_EQ(steps()[1].state, control::StepState::kDone);
}

TEST_F(LoadChange, DumpingAnEmptyBucketFallsShort) {
  run("ew180", "", "<dump><hold_s>0.2</hold_s></dump><wait><duration_s>1</duration_s></wait>");
  ASSERT_EQ(steps().size(), 1u);
  EXPECT_EQ(steps()[0].state, control::StepState::kStalled);
  EXPECT_EQ(steps()[0].reason, "the bucket was empty: nothing could leave it");
  EXPECT_EQ(value(steps()[0], "dumped_kg"), 0);
}

TEST_F(LoadChange, UnhitchingAnOpenHitchIsReported) {
  const LogLines log;
  run("robot", "", "<unhitch><hitch>hitch</hitch></unhitch><unhitch><hitch>hitch</hitch></unhitch>",
      "<include><uri>model://robot_trailer</uri><name>trailer</name><pose>-1 0 0 0 0 0</pose>"
      "</include><navvy:hitch name=\"hitch\"><parent>machine::chassis</parent>"
      "<child>trailer::chassis</child><hook_m>-0.4 0 0.15</hook_m><eye_m>0.6 0 0.15</eye_m>"
      "</navvy:hitch>");
  ASSERT_EQ(steps().size(), 2u);
  EXPECT_EQ(steps()[0].reason, "");
  EXPECT_EQ(steps()[1].reason, "the hitch 'hitch' was open already");
  EXPECT_EQ(steps()[1].state, control::StepState::kDone);
  EXPECT_NE(log.text().find("step 2 (unhitch): the hitch 'hitch' was open already"),
            std::string::npos)
      << log.text();
}

TEST_F(LoadChange, AnEmptyProgramIsReported) {
  const LogLines log;
  load("robot", "", "");
  EXPECT_NE(log.text().find("the program has no steps: nothing operates the machine"),
            std::string::npos)
      << log.text();
}

/// Returns the program of an excavator that digs one cycle into the bed of 'truck'.
std::string dig_into(const std::string& into) {
  return "<dig><from_m>7.5 0</from_m><to_m>5.5 0</to_m><depth_m>0.5</depth_m>"
         "<dump_at_m>0 6.5</dump_at_m><dump_height_m>2.3</dump_height_m><into>" +
         into + "</into><max_cycles>1</max_cycles></dig>";
}
std::string truck(const std::string& pose) {
  return "<include><uri>model://dumper</uri><name>truck</name><pose>" + pose + "</pose></include>";
}

TEST_F(LoadChange, ADigStatesWhatLandsInItsReceiver) {
  run("ew180", "", dig_into("truck"), truck("0.5 6.5 0 0 0 0"));
  ASSERT_EQ(steps().size(), 1u);
  EXPECT_NE(steps()[0].state, control::StepState::kStalled) << steps()[0].reason;
  const double landed = value(steps()[0], "landed_in_cycle_1_kg");
  EXPECT_EQ(value(steps()[0], "landed_kg"), landed);
  EXPECT_GT(landed, 0.5 * session_->cycles().at(0).payload_dump);
  EXPECT_LT(landed, 1.01 * session_->cycles().at(0).payload_dump);
}

TEST_F(LoadChange, ADigThatMissesItsReceiverFallsShort) {
  run("ew180", "", dig_into("truck"), truck("-8 6.5 0 0 0 0"));
  ASSERT_EQ(steps().size(), 1u);
  EXPECT_EQ(steps()[0].state, control::StepState::kStalled);
  EXPECT_NE(steps()[0].reason.find("of cycle 1 only 0.00 kg landed in 'truck'"), std::string::npos)
      << steps()[0].reason;
  EXPECT_EQ(value(steps()[0], "landed_kg"), 0);
}

TEST_F(LoadChange, AReceiverWithoutABedIsRefused) {
  for (const std::string into : {"machine", "trukc"}) {
    try {
      run("ew180", "", dig_into(into), truck("0.5 6.5 0 0 0 0"));
      ADD_FAILURE() << into;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("must be the name of another machine with a bed"),
                std::string::npos)
          << error.what();
    }
  }
}

}  // namespace
}  // namespace navvy::session
