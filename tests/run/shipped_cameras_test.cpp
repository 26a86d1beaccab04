// SPDX-License-Identifier: Apache-2.0
// What the cameras of the shipped scenes show, by projection.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string>
#include <vector>

#include "control/step_kinds.h"
#include "run/simulation.h"
#include "scene_io/loader.h"
#include "scene_io/shipped.h"
#include "sim/frame_builder.h"
#include "sim/occupied_areas.h"
#include "vehicle/collision_box.h"

namespace navvy::run {
namespace {

/// Returns the names of the shipped scenes, such as "paper/tracks".
std::vector<std::string> names() {
  std::vector<std::string> out;
  for (const auto& [name, file] : scene_io::shipped_scenes()) out.push_back(name);
  return out;
}

/// Returns the corners of the boxes around a machine's collision shapes, in W [m].
std::vector<Vec3> corners_of(const sim::World& world, std::size_t machine) {
  const sim::MachineHandle handle = world.machines().at(static_cast<int>(machine));
  std::vector<Vec3> out;
  for (std::size_t l = 0; l < handle.description().links.size(); ++l)
    for (const scene::Collision& shape : handle.description().links[l].collisions)
      if (const auto box = vehicle::box_of(shape))
        for (const Vec3& corner : geometry::corners(*box))
          out.push_back(handle.link(static_cast<int>(l)).pose() * corner);
  return out;
}

/// Returns the share of the picture's width that a machine takes, 0 if a part of it is outside.
double share_of_width(const sim::World& world, std::size_t machine,
                      const scene::FrameCamera& camera) {
  double left = 2, right = -2;
  for (const Vec3& corner : corners_of(world, machine)) {
    const Vec3 p = camera.X_WC.inverse() * corner;
    const double tan_x = std::tan(0.5 * camera.fov);
    const double x = p.x() / -p.z() / tan_x,
                 y = p.y() / -p.z() / (tan_x * camera.height / camera.width);
    if (p.z() >= 0 || std::abs(x) > 1 || std::abs(y) > 1) return 0;
    left = std::min(left, x);
    right = std::max(right, x);
  }
  return std::max(0.0, 0.5 * (right - left));
}

/// Expects that a fixed or following camera shows every machine, in scenes of the paper on a
/// quarter of the picture's width.
void expect_shown(const Simulation& simulation, const std::string& name) {
  const sim::World& world = simulation.world();
  sim::FrameBuilder frames(world);
  const scene::Scene& scene = world.description();
  for (std::size_t m = 0; m < scene.machines.size(); ++m) {
    if (!sim::is_machine(scene.machines[m])) continue;
    double most = 0;
    for (const scene::Camera& camera : scene.cameras)
      if (camera.kind != scene::Camera::Kind::kOnLink)
        most = std::max(most, share_of_width(world, m, frames.camera(camera)));
    EXPECT_GT(most, name.rfind("paper/", 0) == 0 ? 0.25 : 0.02)
        << name << " at " << world.time() << " s: " << scene.machines[m].name;
  }
}

scene::Scene load(const std::string& name) {
  scene_io::Overrides overrides;
  overrides.render = false;
  return scene_io::load_scene(scene_io::find_scene(name), control::step_kinds(), overrides);
}

class ShippedCameras : public testing::TestWithParam<std::string> {};

TEST_P(ShippedCameras, ShowEveryMachineInTheFirstSecond) {
  Simulation simulation(load(GetParam()));
  expect_shown(simulation, GetParam());
  while (simulation.time() < 1) simulation.step(100);
  expect_shown(simulation, GetParam());
}

INSTANTIATE_TEST_SUITE_P(All, ShippedCameras, testing::ValuesIn(names()),
                         [](const testing::TestParamInfo<std::string>& test) {
                           std::string name = test.param;
                           std::replace_if(
                               name.begin(), name.end(),
                               [](unsigned char c) { return !std::isalnum(c); }, '_');
                           return name;
                         });

TEST(ShippedCamera, ShowsTheRobotOverTheWholeRun) {
  Simulation simulation(load("paper/diff_kinematic"));
  while (!simulation.done()) {
    simulation.step(200);
    expect_shown(simulation, "paper/diff_kinematic");
  }
}

}  // namespace
}  // namespace navvy::run
