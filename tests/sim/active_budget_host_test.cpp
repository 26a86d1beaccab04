// SPDX-License-Identifier: Apache-2.0
// The particle budget is checked against initially active soil before memory is allocated.
#include <gtest/gtest.h>

#include "control/step_kinds.h"
#include "core/error.h"
#include "heightfield/make_ground.h"
#include "scene_io/loader.h"
#include "sim/start_placing.h"

namespace navvy::sim {
namespace {

/// Returns a site of 24 by 24 m with active soil above `bottom` in a square of this width.
scene::Scene active_square(double width, double bottom, int budget) {
  const std::string w = std::to_string(width);
  return scene_io::load_scene_from_string(
      "<sdf version=\"1.9\" xmlns:navvy=\"navvy\"><world name=\"w\"><navvy:soil "
      "ref=\"loam\"/><navvy:ground>"
      "<size_m>24 24</size_m><depth_m>2</depth_m><active><min_m>0 0</min_m><max_m>" +
          w + " " + w + "</max_m><bottom_m>" + std::to_string(bottom) +
          "</bottom_m></active></navvy:ground><navvy:solver><cell_m>0.1</cell_m><max_particles>" +
          std::to_string(budget) + "</max_particles></navvy:solver></world></sdf>",
      "mine.sdf", control::step_kinds());
}

void check(const scene::Scene& scene) {
  check_active(scene, heightfield::make_ground(scene, nullptr));
}

TEST(LimitsOfActiveSoil, RefuseABoxAboveTheBudgetByName) {
  // 10 m by 10 m by 1 m in cells of 0.1 m: 100 000 cells of eight particles.
  EXPECT_NO_THROW(check(active_square(10, -1, 801'000)));
  try {
    check(active_square(10, -1, 700'000));
    FAIL() << "was not refused";
  } catch (const InputError& error) {
    const std::string text = error.faults().front().text();
    EXPECT_NE(text.find("active[1]"), std::string::npos) << text;
    EXPECT_NE(text.find("more soil than the 700000 particles"), std::string::npos) << text;
  }
}

TEST(LimitsOfActiveSoil, IgnoreABoxAboveTheGround) {
  EXPECT_NO_THROW(check(active_square(2, 5, 1000)));
}

}  // namespace
}  // namespace navvy::sim
