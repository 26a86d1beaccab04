// SPDX-License-Identifier: Apache-2.0
// Faults: each stops the run with step and cause and leaves a state that a snapshot can hold, or is
// bounded.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "device/device_error.h"
#include "soil/rig.h"

namespace navvy::soil {
namespace {

using rig::Rig;
using rig::SiteBox;

const SiteBox kBed{Vec3(9, 9.2, -0.6), Vec3(10.6, 10.4, 0)};

/// Pushes a blade at `speed` into the bed for `seconds`; returns why it stopped, or "".
std::string push(Rig& rig, double speed, double seconds) {
  ToolMotion motion;
  motion.tool = rig.solver().add_tool(rig::blade(0.8, 0.6));
  motion.X_WT = make_pose(8.9, 9.8, -0.3);
  motion.v_WT = Vec3(speed, 0, 0);
  rig.solver().insert(rig.fill(kBed, true));
  constexpr double kStep = 1.6e-3;
  ToolImpulse impulse;
  try {
    for (double t = 0; t < seconds; t += kStep) {
      rig.solver().step(kStep, std::span(&motion, 1), std::span(&impulse, 1));
      motion.X_WT.translation() += kStep * motion.v_WT;
      EXPECT_TRUE(impulse.J_W.allFinite());
    }
  } catch (const SimulationError& error) {
    return error.what();
  }
  return "";
}

/// Saves the state and loads it again, with its mass.
void expect_saved_whole(Rig& rig, Rig& fresh) {
  load_saved(saved(rig.solver()), fresh.solver());
  EXPECT_EQ(fresh.solver().particles().size(), rig.solver().particles().size());
  EXPECT_EQ(fresh.solver().ledger().error(), 0);
}

TEST(SoilFaults, AToolFasterThanWavesInTheSoilStopsTheRun) {
  Rig rig({rig::sand()}, kBed), fresh({rig::sand()}, kBed);
  const std::string cause = push(rig, 50, 0.1);
  EXPECT_NE(cause.find("soil step 0"), std::string::npos) << cause;
  EXPECT_NE(cause.find("tool 'blade'"), std::string::npos) << cause;
  EXPECT_NE(cause.find("50"), std::string::npos) << cause;
  EXPECT_EQ(rig.solver().ledger().error(), 0);
  fresh.solver().add_tool(rig::blade(0.8, 0.6));
  expect_saved_whole(rig, fresh);
}

TEST(SoilFaults, AToolAtFiftyMetresPerSecondInStiffSoilIsSteppedFinely) {
  scene::Soil stiff = rig::sand();
  stiff.young_modulus = 2e7;  // waves of 127 m/s
  Rig rig({stiff}, kBed);
  EXPECT_EQ(push(rig, 50, 0.016), "");  // 0.8 m of travel
  EXPECT_EQ(rig.solver().ledger().error(), 0);
  double fastest = 0;
  for (const Particle& p : rig.solver().particles())
    for (const float v : p.v) fastest = std::max(fastest, std::abs(static_cast<double>(v)));
  EXPECT_GT(fastest, 25);
  EXPECT_LT(fastest, 200) << "thrown no faster than four times the blade";
}

TEST(SoilFaults, ANumberThatIsNotFiniteInMidRunIsNamedAndTheSnapshotShowsWhere) {
  Rig rig({rig::sand()}, kBed), fresh({rig::sand()});
  auto soil = rig.fill(kBed, true);
  rig.solver().insert(soil);
  rig.run(0.02);
  const std::uint64_t steps = rig.solver().stats().steps;
  Particle bad = soil[7];
  bad.v[2] = std::nanf("");
  rig.solver().insert({bad});
  std::string cause;
  try {
    rig.run(0.02);
  } catch (const SimulationError& error) {
    cause = error.what();
  }
  EXPECT_NE(cause.find("soil step " + std::to_string(steps)), std::string::npos) << cause;
  EXPECT_NE(cause.find("not finite"), std::string::npos) << cause;
  load_saved(saved(rig.solver()), fresh.solver());
  const std::vector<Particle> saved = fresh.solver().particles();
  EXPECT_EQ(saved.size(), soil.size() + 1);
  EXPECT_TRUE(std::any_of(saved.begin(), saved.end(),
                          [](const Particle& p) { return !std::isfinite(p.v[2]); }));
  EXPECT_GE(fresh.solver().ledger().error(), bad.mass) << "what is not finite counts as lost";
}

TEST(SoilFaults, ToolMotionsMustBeFinite) {
  Rig rig({rig::sand()}, kBed);
  const std::string cause = push(rig, std::nan(""), 0.01);
  EXPECT_NE(cause.find("not finite"), std::string::npos) << cause;
}

TEST(SoilFaults, AToolPressedIntoTheRockStopsTheRunAtTheRock) {
  Rig rig({rig::sand()}, SiteBox{Vec3(9, 9.2, -4), Vec3(10.6, 10.4, 0)}), fresh({rig::sand()});
  ToolMotion motion;
  motion.tool = rig.solver().add_tool(rig::open_box(0.6, 0.6, 0.4));
  motion.X_WT = make_pose(9.8, 9.8, -3.5, kPi, 0, 0);
  motion.v_WT = Vec3(0, 0, -1);
  rig.solver().insert(rig.fill({Vec3(9.2, 9.4, -4), Vec3(10.4, 10.2, -3.6)}, true));
  ToolImpulse impulse;
  std::string cause;
  double most = 0;
  try {
    for (int i = 0; i < 2000; ++i) {
      rig.solver().step(1e-3, std::span(&motion, 1), std::span(&impulse, 1));
      motion.X_WT.translation() += 1e-3 * motion.v_WT;
      most = std::max(most, impulse.J_W.z() / 1e-3);
    }
  } catch (const SimulationError& error) {
    cause = error.what();
  }
  std::printf("largest push before: %.0f N\n%s\n", most, cause.c_str());
  EXPECT_NE(cause.find("rock"), std::string::npos) << cause;
  EXPECT_NE(cause.find("soil step"), std::string::npos) << cause;
  EXPECT_LT(motion.X_WT.translation().z(), -3.6);
  EXPECT_GT(motion.X_WT.translation().z(), -4.2) << "one cell below the rock and not farther";
  fresh.solver().add_tool(rig::open_box(0.6, 0.6, 0.4));
  expect_saved_whole(rig, fresh);
}

TEST(SoilFaults, SoilWithoutDensityIsRefused) {
  for (const double density : {0.0, std::nan("")}) {
    scene::Soil soil = rig::sand();
    soil.bank_density = density;
    try {
      Rig rig({soil});
      FAIL() << "density " << density << " was taken";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("bank_density"), std::string::npos) << error.what();
    }
  }
}

TEST(SoilFaults, AFullDeviceStopsTheRunAndKeepsEveryParticle) {
  const SiteBox big{Vec3(5, 5, -2), Vec3(9, 9, 0)};
  std::size_t wanted = 0;
  std::vector<Particle> all;
  {
    Rig rig({rig::sand()}, big);
    all = rig.fill(big, true);
    wanted = all.size();
  }
  // 120 bytes per particle, once for the state and once more for the first re-bin: the limit lies
  // between.
  const std::size_t state = 120 * wanted;
  setenv("NAVVY_DEVICE_MEMORY_MIB", std::to_string((state * 7 / 4) >> 20).c_str(), 1);
  device::Device small;
  unsetenv("NAVVY_DEVICE_MEMORY_MIB");
  scene::Scene world;
  world.soils = {rig::sand()};
  world.solver.exchange = false;
  Rig place({rig::sand()}, big);
  Solver solver(small, world, place.ground());
  std::string cause;
  try {
    solver.insert(all);
    for (int i = 0; i < 200; ++i) solver.step(1e-3, {}, {});
  } catch (const device::DeviceError& error) {
    cause = error.what();
  }
  std::printf("%.1f MiB of %.1f in use\n%s\n", static_cast<double>(small.memory_used()) / (1 << 20),
              static_cast<double>(small.info().memory) / (1 << 20), cause.c_str());
  EXPECT_NE(cause.find("bytes are in use"), std::string::npos) << cause;
  EXPECT_EQ(solver.particles().size(), wanted);
  EXPECT_EQ(solver.ledger().error(), 0);
  // The snapshot continues on a device with enough memory.
  Solver larger(Rig::device(), world, place.ground());
  load_saved(saved(solver), larger);
  EXPECT_EQ(larger.particles().size(), wanted);
  larger.step(1e-3, {}, {});
  EXPECT_EQ(larger.ledger().error(), 0);
}

}  // namespace
}  // namespace navvy::soil
