// SPDX-License-Identifier: Apache-2.0
// What the cameras of the shipped scenes show, by projection.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <string>
#include <vector>

#include "control/step_kinds.h"
#include "machine_pictures.h"
#include "run/simulation.h"
#include "scene_io/loader.h"
#include "scene_io/shipped.h"

namespace navvy::run {
namespace {

/// Returns the names of the shipped scenes, such as "paper/tracks".
std::vector<std::string> names() {
  std::vector<std::string> out;
  for (const auto& [name, file] : scene_io::shipped_scenes()) out.push_back(name);
  return out;
}

/// Returns the share of the picture's width that each machine of a scene must exceed: a quarter in
/// the paper's scenes.
double wanted_share(const std::string& name) { return name.rfind("paper/", 0) == 0 ? 0.25 : 0.02; }

scene::Scene load(const std::string& name) {
  scene_io::Overrides overrides;
  overrides.render = false;
  return scene_io::load_scene(scene_io::find_scene(name), control::step_kinds(), overrides);
}

class ShippedCameras : public testing::TestWithParam<std::string> {};

TEST_P(ShippedCameras, ShowEveryMachineInTheFirstSecond) {
  Simulation simulation(load(GetParam()));
  navvy::test::MachinePictures pictures(simulation.world());
  pictures.expect_shown(wanted_share(GetParam()));
  while (simulation.time() < 1) simulation.step(100);
  pictures.expect_shown(wanted_share(GetParam()));
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
  navvy::test::MachinePictures pictures(simulation.world());
  while (!simulation.done()) {
    simulation.step(200);
    pictures.expect_shown(wanted_share("paper/diff_kinematic"));
  }
}

}  // namespace
}  // namespace navvy::run
