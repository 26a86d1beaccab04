// SPDX-License-Identifier: Apache-2.0
// Momentum balance while digging, from both sides of the bucket: the machine with its weight, tyres
// and the soil's impulses; the soil in a box that is itself a tool, so that the forces of its floor
// and walls are measured too.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "control/activities/drive_to.h"
#include "sim/world_parts.h"
#include "soil/rig.h"
#include "validation/report.h"
#include "validation/scenes.h"

namespace navvy::validation {
namespace {

constexpr const char* kSource = "conservation of momentum [docs/validation.md, Whole digs]";

/// Returns the trench scene with the machine already at its place.
scene::Scene standing_at_the_trench() {
  scene::Scene world = load_scene("trench.sdf", {"machine.x_m=-4"});
  scene::Program& program = world.machines.at(0).program;
  const auto drives = [](const scene::ProgramStep& step) {
    return step.as<control::DriveTo>() != nullptr;
  };
  program.steps.erase(std::remove_if(program.steps.begin(), program.steps.end(), drives),
                      program.steps.end());
  program.lines.clear();
  return world;
}

TEST(Momentum, OfTheMachineClosesOverASecondOfDigging) {
  const scene::Scene description = standing_at_the_trench();
  double mass = 0;
  for (const scene::Link& link : description.machines[0].machine.links) mass += link.mass;
  session::Session session(description, shared_device());
  const sim::World& world = session.world();
  const auto& tool = parts(world).coupling.tools().at(0);
  while (!session.done() && tool.smooth_W.norm() < 5000) session.step();
  const vehicle::PhysicsEngine& engine = parts(world).coupling.engine(0);
  const int m = parts(world).coupling.index(0);
  const Vec3 start = engine.accounts()->momentum(m);
  const double t0 = world.time();
  Vec3 bucket = Vec3::Zero(), ground = Vec3::Zero();
  double bucket_size = 0, residual = 0;
  while (world.time() < t0 + 1) {
    session.step();
    bucket += tool.impulse.J_W;
    bucket_size += tool.impulse.J_W.norm();
    ground += engine.accounts()->ground_impulse(m);
    if (tool.impulse.scale > 0)
      residual = std::max(residual, tool.impulse.residual.norm() / tool.impulse.scale);
  }
  const Vec3 weight = mass * description.gravity * (world.time() - t0);
  const Vec3 open = engine.accounts()->momentum(m) - start - weight - ground - bucket;
  std::printf(
      "t %.2f s: bucket (%.0f, %.0f, %.0f) N s, tyres (%.0f, %.0f, %.0f), weight %.0f, change "
      "(%.0f, %.0f, %.0f)\n",
      t0, bucket.x(), bucket.y(), bucket.z(), ground.x(), ground.y(), ground.z(), weight.z(),
      (engine.accounts()->momentum(m) - start).x(), (engine.accounts()->momentum(m) - start).y(),
      (engine.accounts()->momentum(m) - start).z());
  expect_between("bucket impulse of 1 s [N s]", bucket_size, 1000, 1e6, "a dig, not a touch");
  expect_between("machine: residual / bucket impulse", open.norm() / bucket_size, 0, 1e-3, kSource);
  expect_between("nodal solve: residual / scale", residual, 0, 1e-5, kSource);
}

/// Momentum of all particles [N s].
Vec3 momentum(const std::vector<soil::Particle>& particles) {
  Vec3 sum = Vec3::Zero();
  for (const soil::Particle& p : particles) sum += kilograms(p.mass) * Vec3(p.v[0], p.v[1], p.v[2]);
  return sum;
}

TEST(Momentum, OfTheSoilClosesOverASecondOfDiggingInABox) {
  // 0.5 m of cohesive soil in a box held 1 m above the ground; a small bucket is drawn through it
  // for a second.
  scene::Soil soil = soil::rig::sand(33);
  soil.cohesion = soil.residual_cohesion = 2000;
  soil::rig::Rig rig({soil});
  soil::Solver& solver = rig.solver();
  const Vec3 corner(9.13, 9.43, 1.04);
  std::array<soil::ToolMotion, 2> motions;
  std::array<soil::ToolImpulse, 2> impulses;
  motions[0].tool = solver.add_tool(soil::rig::open_box(1.8, 1.2, 0.8));
  motions[0].X_WT = make_pose(10.02, 10.01, 1.0, 0, 0, 0);
  // On its side, mouth to -x, its cutting edge 0.3 m above the box's floor.
  motions[1].tool = solver.add_tool(soil::rig::open_box(0.4, 0.4, 0.4));
  motions[1].X_WT = make_pose(10.7, 10.01, 1.75, 0, radians(-80), 0);
  solver.insert(rig.fill({corner, corner + Vec3(1.75, 1.15, 0.5)}));
  const double dt = 1.5e-3;
  const auto go = [&](double seconds, const Vec3& v, const auto& each) {
    motions[1].v_WT = v;
    for (int i = 0; i < static_cast<int>(std::lround(seconds / dt)); ++i) {
      solver.step(dt, motions, impulses);
      motions[1].X_WT.translation() += v * dt;
      each();
    }
  };
  go(0.45, Vec3::Zero(), [] {});
  go(0.3, Vec3(-0.4, 0, -0.6), [] {});
  const std::vector<soil::Particle> before = solver.particles();
  std::int64_t units = 0;
  for (const soil::Particle& p : before) units += p.mass;
  Vec3 box = Vec3::Zero(), bucket = Vec3::Zero();
  double bucket_size = 0, time = 0;
  go(1.0, Vec3(-0.6, 0, 0), [&] {
    box += impulses[0].J_W;
    bucket += impulses[1].J_W;
    bucket_size += impulses[1].J_W.norm();
    time += dt;
  });
  const Vec3 weight = kilograms(units) * rig.world().gravity * time;
  const Vec3 open = momentum(solver.particles()) - momentum(before) - weight + box + bucket;
  std::printf("soil %.0f kg: bucket (%.1f, %.1f, %.1f) N s, box (%.1f, %.1f, %.1f), weight %.1f\n",
              kilograms(units), bucket.x(), bucket.y(), bucket.z(), box.x(), box.y(), box.z(),
              weight.z());
  expect_between("bucket impulse of 1 s [N s]", bucket_size, 100, 1e6, "a dig, not a touch");
  expect_between("soil: residual / bucket impulse", open.norm() / bucket_size, 0, 1e-3, kSource);
  expect_between("ledger error [units]", static_cast<double>(solver.ledger().error()), 0, 0,
                 kSource);
}

}  // namespace
}  // namespace navvy::validation
