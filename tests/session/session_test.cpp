// SPDX-License-Identifier: Apache-2.0
// Whole worlds for a few seconds: repeatability, resuming, hashes of the whole state, forces that
// come from soil.
#include "session/session.h"
#include "control/activities/dig/dig.h"
#include "control/step_kinds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "core/error.h"
#include "core/saved_state.h"
#include "device/device.h"
#include "folder.h"
#include "paths.h"
#include "scene_io/loader.h"
#include "sim/height_grid.h"
#include "sim/world_parts.h"

namespace navvy::session {
namespace {

scene::Scene load(const std::string& name, const std::vector<std::string>& settings = {}) {
  scene_io::Overrides overrides;
  overrides.render = false;
  for (const std::string& setting : settings)
    overrides.set.push_back(scene_io::parse_setting(setting));
  return scene_io::load_scene(navvy::source_dir() + "/scenarios/" + name, control::step_kinds(),
                              overrides);
}

/// The bucket of bucket_path.sdf goes into the ground within the first 1.2 s.
constexpr double kInSoil = 1.6;

class SessionTest : public testing::Test {
 protected:
  std::unique_ptr<Session> make(const scene::Scene& description) {
    return std::make_unique<Session>(description, device_);
  }
  static void run_to(Session& session, double time) {
    while (session.world().time() < time) session.step();
  }
  device::Device device_;
};

TEST_F(SessionTest, TheSameRunTwiceEndsInTheSameState) {
  const scene::Scene description = load("bucket_path.sdf");
  std::string hashes[2];
  for (std::string& hash : hashes) {
    const auto session = make(description);
    run_to(*session, kInSoil);
    EXPECT_GT(session->world().soil().counts().particles, 100);
    hash = session->state_hash();
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

TEST_F(SessionTest, ASnapshotInMidRunResumesToTheSameState) {
  const scene::Scene description = load("bucket_path.sdf");
  const auto whole = make(description);
  run_to(*whole, 1.3);
  const std::vector<char> bytes = saved(*whole);
  const std::string middle = whole->state_hash();
  run_to(*whole, kInSoil);

  const auto resumed = make(description);
  load_saved(bytes, *resumed);
  EXPECT_EQ(resumed->state_hash(), middle);
  run_to(*resumed, kInSoil);
  EXPECT_EQ(resumed->state_hash(), whole->state_hash());
}

TEST_F(SessionTest, AParticleBudgetOnlyReducesActivation) {
  const auto run = [&](const std::string& budget) {
    auto session = make(load("bucket_path.sdf", {"solver.max_particles=" + budget}));
    run_to(*session, 2.2);
    EXPECT_EQ(session->world().soil().mass_ledger().error, 0);
    return session;
  };
  const auto whole = run("100000"), bounded = run("6000");
  EXPECT_GT(whole->world().soil().counts().particles_peak, 10000);
  EXPECT_LE(bounded->world().soil().counts().particles_peak, 6000);
  EXPECT_GT(bounded->world().soil().counts().particles_peak, 3000) << "it still digs";
  EXPECT_EQ(bounded->world().steps(), whole->world().steps());
}

TEST_F(SessionTest, ASnapshotOfAnotherSceneIsRefused) {
  const auto bucket = make(load("bucket_path.sdf"));
  const std::vector<char> bytes = saved(*bucket);
  const auto block = make(load("block_collapse.sdf"));
  EXPECT_THROW(load_saved(bytes, *block), InputError);
}

TEST_F(SessionTest, ABlockThatStartsActiveCollapsesIntoAHeap) {
  const auto session = make(load("block_collapse.sdf"));
  const heightfield::Ground& ground = session->world().ground();
  const int top = static_cast<int>(session->world().soil().counts().particles);
  run_to(*session, 0.8);
  EXPECT_EQ(top, 0);  // counted by the first step
  EXPECT_GT(session->world().soil().counts().particles_peak, 25000);
  // 2 x 2 x 1 m of sand: the heap is wider than the block was and lower than its edge.
  double widest = 0;
  for (const soil::Particle& p : parts(session->world()).soil.particles())
    widest = std::max(widest, ground.origin().x() +
                                  ground.cell() * (4 * p.block[0] + static_cast<double>(p.x[0])));
  EXPECT_GT(widest, 0.6 + 0.5);
  EXPECT_EQ(session->world().soil().mass_ledger().error, 0);
}

TEST_F(SessionTest, ASnapshotOfAWheeledMachineResumesToTheSameState) {
  const scene::Scene description = load("trench.sdf");
  const auto whole = make(description);
  run_to(*whole, 0.8);
  const std::vector<char> bytes = saved(*whole);
  run_to(*whole, 1.2);
  const auto resumed = make(description);
  load_saved(bytes, *resumed);
  run_to(*resumed, 1.2);
  EXPECT_EQ(resumed->state_hash(), whole->state_hash());
}

TEST_F(SessionTest, ARefusedCommandDoesNotStopTheProgram) {
  const scene::Scene description = load("two_excavators.sdf");
  const auto session = make(description);
  run_to(*session, 0.2);
  const std::string phase = session->phase(0);
  const double nan = std::nan("");
  const sim::MachineHandle machine = session->world().machines().at(0);
  EXPECT_THROW(session->command(machine.joint(0), {vehicle::JointMode::kVelocity, nan}),
               InputError);
  EXPECT_THROW(session->command(machine, {nan, 0, false}), InputError);
  EXPECT_THROW(session->command(sim::MachineHandle(), {0, 0, true}), InputError);
  EXPECT_THROW(session->command(sim::JointHandle(), {vehicle::JointMode::kVelocity, 0}),
               InputError);
  const int bucket =
      description.machines.at(0).machine.joint_index(description.machines.at(0).machine.arm.bucket);
  EXPECT_THROW(session->brake(machine.joint(bucket), true), InputError)
      << "a joint without a brake";
  EXPECT_EQ(session->phase(0), phase);
}

TEST_F(SessionTest, AnInputBeyondItsBoundsDoesNotStopTheProgram) {
  const auto session = make(load("two_excavators.sdf"));
  run_to(*session, 0.2);
  const std::string phase = session->phase(0);
  const std::string machine = session->world().description().machines.at(0).name;
  EXPECT_THROW(session->set(machine + "/levers/left_y", 55), InputError);
  EXPECT_EQ(session->phase(0), phase);
  session->set(machine + "/levers/left_y", 1);
  EXPECT_EQ(session->phase(0), "inputs");
}

TEST_F(SessionTest, AnInputEndsOnlyTheProgramOfItsMachine) {
  // Both excavators drive and dig; the first one is stopped during the drive and keeps the pose it
  // had.
  const scene::Scene description = load("two_excavators.sdf");
  const auto session = make(description);
  const sim::World& world = session->world();
  run_to(*session, 3);
  ASSERT_EQ(session->phase(0), session->phase(1));
  const std::string first = description.machines.at(0).name;
  session->set(first + "/drive/brake", 1);
  EXPECT_EQ(session->phase(0), "inputs");
  EXPECT_NE(session->phase(1), "inputs");
  run_to(*session, 4);
  const Vec3 place = world.machines().at(0).link(0).pose().translation();
  const int boom =
      description.machines[0].machine.joint_index(description.machines[0].machine.arm.boom);
  const double angle = world.machines().at(0).joint(boom).position();
  const std::vector<char> bytes = saved(*session);
  run_to(*session, 6);
  EXPECT_LT((world.machines().at(0).link(0).pose().translation() - place).norm(), 0.02) << "braked";
  EXPECT_NEAR(world.machines().at(0).joint(boom).position(), angle, 0.005);
  EXPECT_FALSE(session->done());
  const auto resumed = make(description);
  load_saved(bytes, *resumed);
  EXPECT_EQ(resumed->phase(0), "inputs");
  run_to(*resumed, 6);
  EXPECT_EQ(resumed->state_hash(), session->state_hash());
}

TEST_F(SessionTest, ACommandByHandleEndsTheProgramAndARefusedInputDoesNot) {
  const auto session = make(load("bucket_path.sdf"));
  session->step();
  EXPECT_THROW(session->set("bucket/slide_x/velocity", std::nan("")), InputError);
  EXPECT_THROW(session->set("bucket/slyde_x/velocity", 1), InputError);
  EXPECT_EQ(session->phase(0), "trajectory");
  const sim::JointHandle slide = session->world().machines().at("bucket").joint("slide_x");
  const double start = slide.position(), begun = session->world().time();
  session->command(slide, {vehicle::JointMode::kVelocity, 0.5});
  EXPECT_EQ(session->phase(0), "inputs");
  run_to(*session, 0.1);
  // A kinematic machine moves exactly as commanded.
  EXPECT_NEAR(slide.position() - start, 0.5 * (session->world().time() - begun), 1e-9);
}

TEST_F(SessionTest, ASensorIsAddedThroughSimAndSavedInSnapshots) {
  const scene::Scene description = load("bucket_path.sdf");
  const auto with_grid = [&] {
    auto session = make(description);
    session->add(
        std::make_unique<sim::testing::HeightGrid>(session->world().machines().at(0), 5, 0.2, 20));
    return session;
  };
  const auto whole = with_grid();
  run_to(*whole, 0.2);
  const sim::ArrayView grid = whole->world().arrays().view("bucket/height_grid");
  EXPECT_EQ(grid.sequence(), 1u + 4u);
  EXPECT_EQ(grid.values<float>().size(), 25u);
  const std::vector<char> bytes = saved(*whole);
  run_to(*whole, 0.3);
  const auto resumed = with_grid();
  load_saved(bytes, *resumed);
  run_to(*resumed, 0.3);
  EXPECT_EQ(resumed->state_hash(), whole->state_hash());
}

TEST_F(SessionTest, ADriveCommandByChannelsIsRestoredFromASnapshot) {
  scene::Scene description = load("trench.sdf");
  description.machines[0].program.steps.clear();
  const auto first = make(description);
  first->set("excavator/drive/speed", 1.5);
  const std::vector<char> bytes = saved(*first);
  const auto second = make(description);
  load_saved(bytes, *second);
  const sim::World& resumed = second->world();
  second->set("excavator/drive/steer", 0.2);
  EXPECT_EQ(resumed.machines().at(0).drive().speed,
            1.5);  // steering alone does not stop the machine
  EXPECT_EQ(resumed.machines().at(0).drive().steer, 0.2);
  EXPECT_FALSE(resumed.machines().at(0).drive().brake);
}

TEST_F(SessionTest, ForceComesFromSoilAndOnlyFromSoil) {
  const auto session = make(load("bucket_path.sdf"));
  double in_air = 0, in_soil = 0;
  while (session->world().time() < kInSoil) {
    session->step();
    const double force = session->world().machines().at("bucket").tool(0).force().norm();
    (session->world().time() < 0.3 ? in_air : in_soil) =
        std::max(session->world().time() < 0.3 ? in_air : in_soil, force);
  }
  EXPECT_EQ(in_air, 0);  // 0.2 m above untouched ground
  EXPECT_GT(in_soil, 500);
}

TEST_F(SessionTest, FourTimesTheCohesionRequiresMoreForce) {
  double mean[2];
  const char* cohesion[] = {"soil.cohesion_pa=5000", "soil.cohesion_pa=20000"};
  for (int i = 0; i < 2; ++i) {
    const auto session = make(load("bucket_path.sdf", {cohesion[i]}));
    run_to(*session, kInSoil);
    mean[i] = session->force().mean();
  }
  EXPECT_GT(mean[1], 1.2 * mean[0]);
}

TEST_F(SessionTest, MomentumOfTheNodalSolveAndTheLedgerCloseEveryStep) {
  const auto session = make(load("bucket_path.sdf"));
  while (session->world().time() < kInSoil) {
    session->step();
    if (session->world().steps() % 50 == 0)
      ASSERT_EQ(session->world().soil().mass_ledger().error, 0);
  }
  EXPECT_LE(session->force().residual_max, 1e-5);  // rounding [docs/tools.md, ledger]
  EXPECT_EQ(session->world().soil().counts().shell_crossings, 0u);
}

TEST_F(SessionTest, TwoExcavatorsStandInOneWorld) {
  const auto session = make(load("two_excavators.sdf"));
  run_to(*session, 0.5);
  for (int m = 0; m < 2; ++m) {
    double load = 0;
    for (int w = 0; w < 4; ++w)
      load += session->world().machines().at(m).wheel(w).state().force_W.z();
    // 18 t at rest; the springs still oscillate a little.
    EXPECT_NEAR(load, 18000 * kGravity, 0.15 * 18000 * kGravity) << "machine " << m;
  }
}

TEST_F(SessionTest, AnUnreachableTrenchIsReportedBeforeTheRun) {
  scene::Scene description = load("trench.sdf");
  for (scene::ProgramStep& step : description.machines[0].program.steps)
    if (const auto* dig = step.as<control::Dig>()) {
      control::Dig far = *dig;
      far.from.x() += 4;
      step = far;
    }
  try {
    make(description);
    FAIL() << "a trench 12 m away was accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("far"), std::string::npos) << error.what();
  }
}

TEST_F(SessionTest, ListsChannelsAndSuggestsTheNearestForAWrongName) {
  const auto session = make(load("trench.sdf"));
  const sim::World& world = session->world();
  EXPECT_NO_THROW(session->set("excavator/boom_joint/position", 0.5));
  EXPECT_NEAR(world.outputs().get("excavator/pose/x"), -9, 1e-9);
  EXPECT_THROW(session->set("excavator/boom_joint/position", std::nan("")), InputError);
  try {
    world.outputs().get("excavator/bom_joint/position");
    FAIL() << "an unknown output was accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("excavator/boom_joint/position"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace navvy::session
