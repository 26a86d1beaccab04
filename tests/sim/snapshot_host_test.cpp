// SPDX-License-Identifier: Apache-2.0
// Checks of a snapshot's start. They need no OpenCL device: this program has the label host.
#include "sim/snapshot.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "core/error.h"
#include "core/saved_state.h"
#include "heightfield/make_ground.h"
#include "sim/scenes.h"

namespace navvy::sim {
namespace {

SnapshotStart start_in(const scene::Scene& scene) {
  return {start_of(scene, heightfield::make_ground(scene)), scene.name};
}

/// Returns the message with which `here` refuses a snapshot of `scene`; "" if it is accepted.
std::string refusal(const scene::Scene& scene, const scene::Scene& here) {
  SnapshotStart start = start_in(here);
  try {
    load_saved(saved(start_in(scene)), start);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Snapshot, OfAnotherSceneIsRefusedByItsName) {
  const scene::Scene scene = testing::load("bucket_path.sdf");
  const std::string said = refusal(scene, testing::load("block_collapse.sdf"));
  EXPECT_NE(said.find("'block_collapse'"), std::string::npos) << said;
}

/// Each of the three alone, changed by the smallest amount that affects a run.
TEST(Snapshot, OfAnotherMassCohesionOrPlaceIsRefusedWithTheDifference) {
  const scene::Scene scene = testing::load("bucket_path.sdf");
  EXPECT_EQ(refusal(scene, scene), "");
  scene::Scene heavier = scene;
  ASSERT_FALSE(heavier.machines.at(0).machine.links.empty());
  heavier.machines[0].machine.links.back().mass += 1;
  scene::Scene stronger = scene;
  stronger.soils.at(0).cohesion += 1;
  scene::Scene aside = scene;
  aside.machines.at(0).X_WM.translation().x() += 0.001;
  const std::string link = heavier.machines[0].machine.links.back().name;
  for (const auto& [here, difference] :
       {std::pair(&heavier, "link[" + link + "]/mass"),
        std::pair(&stronger, std::string("soil[loam]/cohesion")),
        std::pair(&aside, std::string("machine[bucket]/pose/place"))}) {
    const std::string said = refusal(scene, *here);
    EXPECT_NE(said.find(difference), std::string::npos) << difference << ": " << said;
    EXPECT_NE(said.find("--resume-anyway"), std::string::npos) << said;
  }
}

}  // namespace
}  // namespace navvy::sim
