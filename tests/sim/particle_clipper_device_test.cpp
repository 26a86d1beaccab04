// SPDX-License-Identifier: Apache-2.0
#include "sim/particle_clipper.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "device/device.h"
#include "sim/scenes.h"
#include "soil/tools/shell_geometry.h"

namespace navvy::sim {
namespace {

/// First shell of a scene's first machine, at its pose in the world.
struct ShellInWorld {
  explicit ShellInWorld(const World& world)
      : geometry(world.description().machines[0].machine.shells.at(0), world.ground().cell()) {
    const scene::Machine& machine = world.description().machines[0].machine;
    X_WT = world.machines().at(0).link(machine.link_index(geometry.shell().link)).pose();
  }
  soil::ShellGeometry geometry;
  Pose X_WT = Pose::Identity();
};

void add(scene::FrameParticles& to, const Vec3& p_W) {
  for (int a = 0; a < 3; ++a) to.position.push_back(static_cast<float>(p_W[a] - to.origin[a]));
}

Vec3 place(const scene::FrameParticles& of, std::size_t i) {
  return of.origin + Vec3(of.position[3 * i], of.position[3 * i + 1], of.position[3 * i + 2]);
}

TEST(ParticleClipperTest, IsTheDistanceToTheFaceOfTheClosestPlateUpToItsReach) {
  device::Device device;
  const World world(testing::load("trench.sdf"), device);
  const ShellInWorld shell(world);
  const soil::ShellGeometry& geometry = shell.geometry;
  // In front of and behind the middle of every triangle, where it is the closest: at most 3 cm from
  // its plate.
  scene::FrameParticles particles;
  particles.origin = shell.X_WT.translation();
  std::vector<double> expected;
  constexpr double kReach = 0.1;
  for (const auto& triangle : geometry.triangles())
    for (const double side : {0.03, -0.03}) {
      const Vec3 p_T = (triangle.corner[0] + triangle.corner[1] + triangle.corner[2]) / 3 +
                       side * triangle.normal;
      add(particles, shell.X_WT * p_T);
      expected.push_back(
          std::max(0.0, std::abs(geometry.distance(p_T)) - geometry.shell().half_thickness));
    }
  add(particles, shell.X_WT * Vec3(0, 0, 5));
  expected.push_back(kReach);
  ParticleClipper(world).keep_off(particles, 0, kReach);
  ASSERT_EQ(particles.clearance.size(), expected.size());
  // Places are floats: a hundredth of a millimetre.
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_NEAR(particles.clearance[i], expected[i], 1e-5) << i;
  EXPECT_LE(particles.clearance[0], 0.03f);
}

TEST(ParticleClipperTest, KeepsDrawnParticlesOffTheFacesOnTheirOwnSide) {
  device::Device device;
  const World world(testing::load("trench.sdf"), device);
  const ShellInWorld shell(world);
  const soil::ShellGeometry& geometry = shell.geometry;
  const double half = geometry.shell().half_thickness;
  constexpr double kGap = 0.03, kReach = 0.1;
  // From the plate's middle to beyond the gap, on both sides of every triangle's middle.
  scene::FrameParticles particles;
  particles.origin = shell.X_WT.translation();
  std::vector<Vec3> before;
  for (const auto& triangle : geometry.triangles())
    for (const double off : {1e-4, -1e-4, 0.5 * half, -0.5 * half, half + 0.01, -half - 0.01,
                             half + 0.06, -half - 0.06}) {
      before.emplace_back((triangle.corner[0] + triangle.corner[1] + triangle.corner[2]) / 3 +
                          off * triangle.normal);
      add(particles, shell.X_WT * before.back());
    }
  ParticleClipper(world).keep_off(particles, kGap, kReach);
  std::size_t moved = 0, close = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const Vec3 p_T = shell.X_WT.inverse() * place(particles, i);
    const double was = geometry.distance(before[i]), now = geometry.distance(p_T);
    EXPECT_GT(was * now, 0) << i << ": through the plate";
    EXPECT_GE(std::abs(now), std::abs(was) - 1e-5) << i << ": nearer than before";
    EXPECT_NEAR(particles.clearance[i], std::clamp(std::abs(now) - half, 0.0, kReach), 2e-5) << i;
    // With enough clearance it does not move.
    if (std::abs(was) - half > kGap + 1e-5) EXPECT_LE((p_T - before[i]).norm(), 1e-5) << i;
    moved += (p_T - before[i]).norm() > 1e-4 ? 1 : 0;
    close += particles.clearance[i] < kGap - 1e-4 ? 1 : 0;
  }
  EXPECT_GE(moved, before.size() / 2);
  // Only the narrowest corners between plates leave less clearance.
  EXPECT_LE(close, before.size() / 50);
}

}  // namespace
}  // namespace navvy::sim
