// SPDX-License-Identifier: Apache-2.0
// The surface for maps and payloads, beside plain computations of the same.
#include "sim/world_terrain.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "control/step_kinds.h"
#include "core/saved_state.h"
#include "device/device.h"
#include "scene_io/loader.h"
#include "sim/world_parts.h"
#include "soil/tools/shell_geometry.h"

namespace navvy::sim {
namespace {

/// Bucket that is dragged through the soil, with a second soil below the first.
class DugWorld : public ::testing::Test {
 protected:
  DugWorld() : world_(made()) {}
  World made() {
    return World(scene_io::load_scene_from_string(
                     R"(<sdf version="1.9" xmlns:navvy="navvy"><world name="w">
<navvy:soil ref="loam"/><navvy:soil ref="gravel"/>
<navvy:ground><size_m>8 6</size_m><depth_m>1.5</depth_m>
<layer><soil>loam</soil><thickness_m>0.25</thickness_m></layer>
<layer><soil>gravel</soil></layer></navvy:ground>
<include><uri>model://test_bucket</uri><name>bucket</name>
<pose>0 0 0 0 0 0</pose><navvy:on_ground>false</navvy:on_ground>
<navvy:joint name="slide_x"><initial_m>-1.2</initial_m></navvy:joint>
<navvy:joint name="slide_z"><initial_m>0.4</initial_m></navvy:joint>
<navvy:joint name="curl"><initial_deg>-70</initial_deg></navvy:joint></include></world></sdf>)",
                     "test.sdf", control::step_kinds()),
                 device_);
  }
  void drive(double down, double ahead, double until) {
    const MachineHandle bucket = world_.machines().at("bucket");
    world_.commands().set(bucket.joint("slide_z"), {vehicle::JointMode::kVelocity, -down});
    world_.commands().set(bucket.joint("slide_x"), {vehicle::JointMode::kVelocity, ahead});
    while (world_.time() < until) world_.step();
  }

  device::Device device_;
  World world_;
};

/// Returns true if the bucket, the only tool, holds the particle; searches all plates.
bool held(const World& world, const soil::ShellGeometry& shell, const soil::Particle& p) {
  Vec3 p_W = parts(world).soil.grid_origin();
  for (int a = 0; a < 3; ++a)
    p_W[a] +=
        world.ground().cell() * (soil::kBlockCells * p.block[a] + static_cast<double>(p.x[a]));
  const MachineHandle bucket = world.machines().at(0);
  const Pose X_WL = bucket.link(bucket.description().link_index(shell.shell().link)).pose();
  return shell.holds(X_WL.inverse() * p_W);
}

/// Compares surface and payload of a world with plain computations from copies of all particles.
void compare(const World& world) {
  const soil::ShellGeometry shell(world.description().machines[0].machine.shells.at(0),
                                  world.ground().cell());
  const heightfield::TerrainView columns = world.ground().view(world.time());
  std::vector<heightfield::LooseGrain> grains;
  std::int64_t payload = 0;
  for (const soil::Particle& p : parts(world).soil.particles()) {
    if (held(world, shell, p)) {
      payload += p.mass;
      continue;
    }
    const auto [ix, iy] = parts(world).soil.grid().column_of(p);
    const double z =
        world.ground().datum() +
        world.ground().cell() * (p.block[2] * soil::kBlockCells + static_cast<double>(p.x[2]));
    const double volume = kilograms(p.mass) * static_cast<double>(p.j0) /
                          world.description().soils[p.soil].bank_density;
    grains.push_back({ix, iy, z, volume, p.soil, p.j0, p.mass});
  }
  const heightfield::TerrainView wanted =
      columns.with(heightfield::LooseSoil(columns, std::move(grains)));
  const heightfield::TerrainView mapped = mapped_surface(world);
  for (int iy = 0; iy < wanted.ny(); ++iy)
    for (int ix = 0; ix < wanted.nx(); ++ix) {
      EXPECT_EQ(mapped.height(ix, iy), wanted.height(ix, iy)) << ix << ' ' << iy;
      EXPECT_EQ(mapped.surface_soil(ix, iy), wanted.surface_soil(ix, iy)) << ix << ' ' << iy;
      EXPECT_EQ(mapped.specific_volume(ix, iy), wanted.specific_volume(ix, iy)) << ix << ' ' << iy;
      EXPECT_EQ(mapped.loose_depth(ix, iy), wanted.loose_depth(ix, iy)) << ix << ' ' << iy;
    }
  EXPECT_EQ(world.machines().at(0).tool(0).payload(), kilograms(payload));
}

TEST_F(DugWorld, HasThePlainSurfaceAndPayloadWhileABucketDigs) {
  compare(world_);
  // Soil that has just become active, then moving, held and falling soil.
  for (const double until : {0.2, 0.3, 0.5, 0.8}) {
    drive(0.4, 0.4, until);
    compare(world_);
  }
  drive(0, 0.7, 2);
  compare(world_);
  EXPECT_GT(world_.machines().at(0).tool(0).payload(), 50);
  drive(-0.7, 0, 2.5);
  compare(world_);
}

TEST_F(DugWorld, HasThePlainSurfaceAndPayloadAfterLoading) {
  const std::vector<char> start = saved(world_);
  drive(0.4, 0.4, 0.8);
  const std::vector<char> dug = saved(world_);
  const double payload = world_.machines().at(0).tool(0).payload();
  load_saved(start, world_);
  compare(world_);
  EXPECT_EQ(world_.machines().at(0).tool(0).payload(), 0);
  load_saved(dug, world_);
  compare(world_);
  EXPECT_EQ(world_.machines().at(0).tool(0).payload(), payload);
}

}  // namespace
}  // namespace navvy::sim
