// SPDX-License-Identifier: Apache-2.0
// The soil as beams meet it, beside a plain computation of the same.
#include "sim/visible_soil.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <tuple>
#include <utility>
#include <vector>

#include "control/step_kinds.h"
#include "device/device.h"
#include "scene_io/loader.h"
#include "sim/world_parts.h"

namespace navvy::sim {
namespace {

/// Surface and balls, sorted by place.
struct PlainSoil {
  heightfield::TerrainView surface;
  std::vector<std::tuple<double, double, double, double>> balls;  ///< x, y, z and radius
};

/// Computes what VisibleSoil does from copies of all particles, without leaving anything out.
PlainSoil plain_soil(const World& world) {
  const heightfield::TerrainView columns = world.ground().view(world.time());
  const std::vector<soil::Particle> particles = parts(world).soil.particles();
  const soil::PlanGrid& grid = parts(world).soil.grid();
  const auto place = [&](const soil::Particle& p) {
    Vec3 out = parts(world).soil.grid_origin();
    for (int a = 0; a < 3; ++a)
      out[a] +=
          world.ground().cell() * (soil::kBlockCells * p.block[a] + static_cast<double>(p.x[a]));
    return out;
  };
  const std::function<bool(const Vec3&)> holds = parts(world).coupling.holding();
  std::vector<std::uint8_t> held;
  held.reserve(particles.size());
  for (const soil::Particle& p : particles) held.push_back(holds(place(p)) ? 1 : 0);
  const auto volume = [&](const soil::Particle& p) {
    return kilograms(p.mass) * static_cast<double>(p.j0) /
           world.description().soils[p.soil].bank_density;
  };
  std::vector<heightfield::LooseGrain> grains;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const soil::Particle& p = particles[i];
    const auto [ix, iy] = grid.column_of(p);
    if (held[i] == 0) grains.push_back({ix, iy, place(p).z(), volume(p), p.soil, p.j0, p.mass});
  }
  PlainSoil out{columns.with(heightfield::LooseSoil(columns, std::move(grains))), {}};
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const soil::Particle& p = particles[i];
    const auto [ix, iy] = grid.column_of(p);
    const Vec3 at = place(p);
    if (held[i] != 0 || at.z() > out.surface.height(ix, iy))
      out.balls.emplace_back(at.x(), at.y(), at.z(), std::cbrt(0.75 / kPi * volume(p)));
  }
  std::sort(out.balls.begin(), out.balls.end());
  return out;
}

/// Compares the soil of a world with the plain computation; returns the number of balls.
std::size_t compare(const World& world, VisibleSoil& soil) {
  soil.update();
  const PlainSoil plain = plain_soil(world);
  for (int iy = 0; iy < plain.surface.ny(); ++iy)
    for (int ix = 0; ix < plain.surface.nx(); ++ix)
      EXPECT_NEAR(soil.surface().height(ix, iy), plain.surface.height(ix, iy), 1e-9)
          << ix << ' ' << iy;
  std::vector<std::tuple<double, double, double, double>> balls;
  for (const SoilBall& ball : soil.balls()) {
    const Vec3 p = soil.origin() + ball.p_O.cast<double>();
    balls.emplace_back(p.x(), p.y(), p.z(), static_cast<double>(ball.radius));
  }
  std::sort(balls.begin(), balls.end());
  EXPECT_EQ(balls.size(), plain.balls.size());
  // Floats of a ball count from a point within some metres, so neighbours in the order of x may
  // have changed places.
  const auto same = [](const auto& a, const auto& b) {
    return std::abs(std::get<0>(a) - std::get<0>(b)) < 1e-6 &&
           std::abs(std::get<3>(a) - std::get<3>(b)) < 1e-6;
  };
  const std::size_t count = std::min(balls.size(), plain.balls.size());
  for (std::size_t i = 0; i < count; ++i) {
    if (i + 1 < count && !same(balls[i], plain.balls[i]) && same(balls[i + 1], plain.balls[i]))
      std::swap(balls[i], balls[i + 1]);
    EXPECT_NEAR(std::get<0>(balls[i]), std::get<0>(plain.balls[i]), 1e-6);
    EXPECT_NEAR(std::get<3>(balls[i]), std::get<3>(plain.balls[i]), 1e-6);
  }
  return balls.size();
}

World world_of(const std::string& machine, device::Device& device) {
  return World(
      scene_io::load_scene_from_string(
          R"(<sdf version="1.9" xmlns:navvy="navvy"><world name="w"><navvy:soil ref="loam"/>
<navvy:ground><size_m>8 6</size_m><depth_m>1.5</depth_m></navvy:ground>)" +
              machine + "</world></sdf>",
          "test.sdf", control::step_kinds()),
      device);
}

TEST(VisibleSoil, IsThePlainOneWhileABucketDigs) {
  device::Device device;
  World world = world_of(R"(<include><uri>model://test_bucket</uri><name>bucket</name>
<pose>0 0 0 0 0 0</pose><navvy:on_ground>false</navvy:on_ground>
<navvy:joint name="slide_x"><initial_m>-1.2</initial_m></navvy:joint>
<navvy:joint name="slide_z"><initial_m>0.4</initial_m></navvy:joint>
<navvy:joint name="curl"><initial_deg>-70</initial_deg></navvy:joint></include>)",
                         device);
  VisibleSoil soil(world);
  EXPECT_EQ(compare(world, soil), 0u) << "no particles yet";
  const MachineHandle bucket = world.machines().at("bucket");
  const auto drive = [&](double down, double ahead, double until) {
    world.commands().set(bucket.joint("slide_z"), {vehicle::JointMode::kVelocity, -down});
    world.commands().set(bucket.joint("slide_x"), {vehicle::JointMode::kVelocity, ahead});
    while (world.time() < until) world.step();
  };
  drive(0.4, 0.4, 0.8);
  drive(0, 0.7, 2);
  // Soil in the bucket, between its walls near the ground.
  EXPECT_GT(compare(world, soil), 500u);
  drive(-0.7, 0, 2.5);
  EXPECT_GT(compare(world, soil), 500u);
}

TEST(VisibleSoil, IsThePlainOneWhileABedTips) {
  device::Device device;
  World world = world_of(R"(<include><uri>model://dumper</uri><name>dumper</name>
<pose>0 0 0 0 0 0</pose><navvy:joint name="tip_joint"><initial_deg>65</initial_deg></navvy:joint>
<navvy:load><soil>loam</soil><mass_kg>300</mass_kg></navvy:load></include>)",
                         device);
  VisibleSoil soil(world);
  for (const double until : {0.0, 0.5, 1.0}) {
    while (world.time() < until) world.step();
    EXPECT_GT(compare(world, soil), 100u) << until;
  }
}

}  // namespace
}  // namespace navvy::sim
