// SPDX-License-Identifier: Apache-2.0
// A hopper: two tools hold soil together, and release it when one of them slides away.
#include <gtest/gtest.h>

#include <array>

#include "soil/rig.h"

namespace navvy::soil {
namespace {

using rig::Rig;

/// Returns a square funnel without a floor: outlet of this width at z = 0, walls out to `mouth` at
/// z = `cone`, upright to `top`. Its inside is its front.
scene::Shell funnel(double outlet, double mouth, double cone, double top) {
  scene::Shell s;
  s.name = "hopper";
  const std::array<std::array<double, 2>, 3> rings{
      {{outlet / 2, 0}, {mouth / 2, cone}, {mouth / 2, top}}};
  for (const auto& [half, z] : rings)
    for (const auto& [x, y] :
         {std::array{-1, -1}, std::array{1, -1}, std::array{1, 1}, std::array{-1, 1}})
      s.vertices.emplace_back(half * x, half * y, z);
  for (int ring = 0; ring < 2; ++ring)
    for (int i = 0; i < 4; ++i) {
      const int a = 4 * ring + i, b = 4 * ring + (i + 1) % 4;
      s.triangles.push_back({a, a + 4, b + 4});
      s.triangles.push_back({a, b + 4, b});
    }
  return s;
}

TEST(SoilHopper, HoldsItsLoadUntilTheGateSlidesAway) {
  scene::Soil soil = rig::sand(33);
  soil.tool_friction_angle = radians(15);
  Rig rig({soil});
  std::array<ToolMotion, 2> motions;
  std::array<ToolImpulse, 2> impulses;
  motions[0].tool = rig.solver().add_tool(funnel(0.6, 1.2, 0.5, 1.0));
  motions[0].X_WT = make_pose(10, 10, 1.5);
  // 0.4 m beyond the outlet on either side
  motions[1].tool = rig.solver().add_tool(lab::plate(1.4, 1.2));
  motions[1].X_WT = make_pose(10, 10, 1.49);
  rig.solver().insert(rig.fill({Vec3(9.5, 9.5, 2.05), Vec3(10.5, 10.5, 2.45)}));
  const double mass = rig.solver().payload(motions[0].tool, motions[0].X_WT);
  constexpr double kStep = 1.6e-3;
  const auto run = [&](double seconds) {
    Vec3 sum = Vec3::Zero();
    const int steps = static_cast<int>(seconds / kStep);
    for (int i = 0; i < steps; ++i) {
      rig.solver().step(kStep, motions, impulses);
      for (ToolMotion& motion : motions) motion.X_WT.translation() += kStep * motion.v_WT;
      sum += impulses[0].J_W + impulses[1].J_W;
    }
    return Vec3(sum / (steps * kStep));
  };
  run(1.5);
  const Vec3 force = run(0.5);
  const double held = rig.solver().payload(motions[0].tool, motions[0].X_WT);
  print_value("hopper and gate, F / (m g)", -force.z() / (mass * kGravity), "1 +-1 %", "weight");
  EXPECT_NEAR(-force.z() / (mass * kGravity), 1, 0.01);
  EXPECT_NEAR(held, mass, 0.01 * mass);
  motions[1].v_WT = Vec3(2, 0, 0);
  run(0.6);
  motions[1].v_WT = Vec3::Zero();
  run(2.5);
  const double left = rig.solver().payload(motions[0].tool, motions[0].X_WT);
  print_value("left in the open hopper [kg]", left, "< 1 % of " + std::to_string(mass),
              "steep, smooth walls");
  EXPECT_LT(left, 0.01 * mass);
  EXPECT_EQ(rig.solver().ledger().error(), 0);
  EXPECT_EQ(rig.solver().stats().shell_crossings, 0u);
}

}  // namespace
}  // namespace navvy::soil
