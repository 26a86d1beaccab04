// SPDX-License-Identifier: Apache-2.0
#include "sim/plate_room.h"

#include <gtest/gtest.h>

#include <cmath>

#include "device/device.h"
#include "sim/scenes.h"
#include "sim/world_parts.h"

namespace navvy::sim {
namespace {

soil::Particle at(const World& world, const Vec3& p_W) {
  const Vec3 grid = (p_W - parts(world).soil.grid_origin()) / world.ground().cell();
  soil::Particle out;
  for (int a = 0; a < 3; ++a) {
    out.block[a] = static_cast<std::int32_t>(std::floor(grid[a] / soil::kBlockCells));
    out.x[a] = static_cast<float>(grid[a] - soil::kBlockCells * out.block[a]);
  }
  return out;
}

TEST(PlateRoomTest, IsTheWayToTheFaceOfTheClosestPlateUpToItsReach) {
  device::Device device;
  const World world(testing::load("trench.sdf"), device);
  const scene::Machine& machine = world.description().machines[0].machine;
  const scene::Shell& shell = machine.shells.at(0);
  const soil::ShellGeometry geometry(shell, world.ground().cell());
  const Pose X_WT = world.machine(0).link(machine.link_index(shell.link)).pose();
  // In front of and behind the middle of every triangle, where it is the closest: at most 3 cm from its plate.
  std::vector<soil::Particle> particles;
  std::vector<double> expected;
  constexpr double kReach = 0.1;
  for (const auto& triangle : geometry.triangles())
    for (const double side : {0.03, -0.03}) {
      const Vec3 p_T = (triangle.corner[0] + triangle.corner[1] + triangle.corner[2]) / 3 + side * triangle.normal;
      particles.push_back(at(world, X_WT * p_T));
      expected.push_back(std::max(0.0, std::abs(geometry.distance(p_T)) - shell.half_thickness));
    }
  particles.push_back(at(world, X_WT * Vec3(0, 0, 5)));
  expected.push_back(kReach);
  const std::vector<float> room = PlateRoom(world).of(particles, kReach);
  ASSERT_EQ(room.size(), particles.size());
  // Places in a block are floats of cells: a hundredth of a millimetre.
  for (std::size_t i = 0; i < room.size(); ++i) EXPECT_NEAR(room[i], expected[i], 1e-5) << i;
  EXPECT_LE(room[0], 0.03f);
}

}  // namespace
}  // namespace navvy::sim
