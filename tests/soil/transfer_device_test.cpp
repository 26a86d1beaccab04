// SPDX-License-Identifier: Apache-2.0
// Transfers of a fixed length: their damping, the effect of half a step, and a run that resumes in
// the middle of one.
#include <gtest/gtest.h>

#include <cmath>

#include "core/saved_state.h"
#include "soil/particles/interval.h"
#include "soil/rig.h"

namespace navvy::soil {
namespace {

using rig::Rig;
using rig::SiteBox;

constexpr int kWhole = 3;  // steps of a transfer at the default Courant number

/// Returns the amplitude of a shear wave v_y = sin(2 pi x / 8 cells) over its two middle waves
/// [m/s].
double amplitude(const Rig& rig, double from, double wave) {
  double sum = 0;
  int count = 0;
  for (const Particle& p : rig.solver().particles()) {
    const double x = rig.position(p).x();
    if (x < from || x >= from + 2 * wave) continue;
    sum += 2 * static_cast<double>(p.v[1]) * std::sin(2 * kPi * x / wave);
    ++count;
  }
  return sum / count;
}

// Opened soil without weight carries no stress: only transfers damp the wave. Half the step has as
// many of them.
TEST(SoilTransfer, DampsAWaveOfEightCellsOncePerTransferWhateverTheStep) {
  const double wave = 0.8;
  for (const int parts : {1, 2}) {
    Rig rig({rig::sand()});
    rig.set_gravity(Vec3::Zero());
    auto soil = rig.fill({Vec3(8, 10, 1), Vec3(8 + 6 * wave, 10.3, 1.3)});
    for (Particle& p : soil) {
      const double x = rig.position(p).x();
      p.j = 1.2f;
      p.v[1] = static_cast<float>(0.1 * std::sin(2 * kPi * x / wave));
      p.c[3] = static_cast<float>(0.1 * 2 * kPi / wave * std::cos(2 * kPi * x / wave));
    }
    rig.solver().insert(soil);
    const double dt = rig.solver().step_limit(0) / parts;
    const auto transfers = [&](int count) {
      for (int i = 0; i < kWhole * parts * count; ++i) rig.solver().step(dt, {}, {});
    };
    transfers(2);
    const double before = amplitude(rig, 8 + 2 * wave, wave);
    transfers(4);
    const double kept = std::pow(amplitude(rig, 8 + 2 * wave, wave) / before, 1 / 4.0);
    print_value("wave of 8 cells kept by a transfer", kept, "0.9917 +-0.0005",
                "[docs/soil.md, transfer]");
    // 1 - 0.025 (k h)^4 is 0.9905; the next order gives 0.9917, as a sum over the weights does.
    EXPECT_NEAR(kept, 0.9917, 5e-4) << parts;
  }
}

/// A yielding plate dragged through a bed of sand, step by step.
struct Drag {
  Drag() : rig({rig::sand(35)}, bed) {
    motion.tool = rig.solver().add_tool(rig::blade(0.5, 0.5));
    motion.inverse_mass.bottomRightCorner<3, 3>() = Mat3::Identity() / 80;
    motion.X_WT = make_pose(10.5, 10.1, -0.2);
    motion.v_WT = Vec3(-0.6, 0.1, -0.2);
  }
  void step() {
    rig.solver().step(1.4e-3, std::span(&motion, 1), std::span(&impulse, 1));
    motion.v_WT += impulse.J_W / 80;
    motion.X_WT.translation() += 1.4e-3 * motion.v_WT;
  }
  const SiteBox bed{Vec3(9.6, 9.7, -0.4), Vec3(10.8, 10.5, 0)};
  Rig rig;
  ToolMotion motion;
  ToolImpulse impulse;
};

TEST(SoilTransfer, GoesOnFromASnapshotInTheMiddleAsIfNothingHappened) {
  constexpr int kSteps = 40;
  Drag whole;
  whole.rig.solver().insert(whole.rig.fill(whole.bed, true));
  std::vector<std::vector<char>> states;
  std::vector<ToolMotion> motions;
  for (int i = 0; i < kSteps; ++i) {
    // Every position within a transfer, of four steps as a rule.
    if (i >= 20 && i < 25) {
      states.push_back(saved(whole.rig.solver()));
      motions.push_back(whole.motion);
    }
    whole.step();
  }
  for (std::size_t s = 0; s < states.size(); ++s) {
    Drag resumed;
    load_saved(states[s], resumed.rig.solver());
    resumed.motion = motions[s];
    for (int i = 20 + static_cast<int>(s); i < kSteps; ++i) resumed.step();
    EXPECT_EQ(resumed.rig.digest(), whole.rig.digest()) << "after " << 20 + s << " steps";
    EXPECT_EQ(resumed.motion.v_WT, whole.motion.v_WT);
  }
}

TEST(SoilTransfer, ReportsTheMeanForceOverAWholeTransfer) {
  Drag drag;
  drag.motion.inverse_mass.setZero();
  drag.motion.v_WT = Vec3(-0.1, 0, 0);
  drag.rig.solver().insert(drag.rig.fill(drag.bed, true));
  const double dt = drag.rig.solver().step_limit(0.1);
  Vec3 before = Vec3::Zero();
  for (int transfer = 0; transfer < 12; ++transfer) {
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < kWhole; ++i) {
      drag.rig.solver().step(dt, std::span(&drag.motion, 1), std::span(&drag.impulse, 1));
      drag.motion.X_WT.translation() += dt * drag.motion.v_WT;
      sum += drag.impulse.J_W;
      // The reported force is that of the previous transfer; during the first one, of its own
      // steps.
      const Vec3 expected = transfer > 0 ? before : Vec3(sum / ((i + 1) * dt));
      EXPECT_LT((drag.impulse.force_W - expected).norm(), 1e-9 * (1 + expected.norm()))
          << transfer << ", step " << i;
    }
    before = sum / (kWhole * dt);
  }
  EXPECT_GT(before.x(), 50);
}

// Soil that comes in or becomes active, or a tool that leaves, ends a transfer: nothing is held
// across it.
TEST(SoilTransfer, EndsWhereSoilOrToolsComeAndGo) {
  Rig rig({rig::sand()});
  rig.solver().insert(rig.fill({Vec3(5, 5, 2), Vec3(5.3, 5.3, 2.3)}));
  const double dt = rig.solver().step_limit(0);
  rig.solver().step(dt, {}, {});
  rig.solver().insert(rig.fill({Vec3(6, 5, 2), Vec3(6.3, 5.3, 2.3)}));
  for (int i = 0; i < 2; ++i) rig.solver().step(dt, {}, {});
  ToolMotion motion;
  motion.tool = rig.solver().add_tool(rig::blade(0.3, 0.3));
  motion.X_WT = make_pose(5.5, 5.1, 2);
  ToolImpulse impulse;
  rig.solver().step(dt, std::span(&motion, 1), std::span(&impulse, 1));
  rig.solver().step(dt, {}, {});
  // Free fall of the first lump over five steps, and of the second over four.
  for (const Particle& p : rig.solver().particles()) {
    const int steps = rig.position(p).x() < 5.7 ? 5 : 4;
    EXPECT_NEAR(static_cast<double>(p.v[2]), -kGravity * dt * steps, 1e-5);
  }
}

}  // namespace
}  // namespace navvy::soil
