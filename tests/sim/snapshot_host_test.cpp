// SPDX-License-Identifier: Apache-2.0
// Reads parts of a snapshot on a machine without OpenCL: this program has the label host and opens
// no device.
#include "sim/snapshot.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "core/error.h"
#include "core/file.h"
#include "core/saved_state.h"
#include "core/sealed.h"
#include "folder.h"
#include "heightfield/make_ground.h"
#include "sim/scenes.h"

namespace navvy::sim {
namespace {

/// A snapshot as a world writes it, up to and including its ground; `dug` has a hole. The rest must
/// not be read.
struct Front {
  SnapshotStart start;
  SnapshotHead head;
  heightfield::Ground& ground;
  std::string rest = "soil, machines and more";

  void visit(Archive& a) {
    a("start", start);
    a("head", head);
    a("ground", ground);
    a.section("rest", 1, [&] { a("rest", rest); });
  }
};

void write(const std::string& path, const scene::Scene& scene, heightfield::Ground& dug) {
  write_file_atomically(
      path, seal(saved(Front{{start_of(scene, dug), scene.name}, {scene.name, 0.001, 250}, dug})));
}

TEST(Snapshot, ReadsItsGroundWithoutADevice) {
  const test::Folder folder;
  const scene::Scene scene = testing::load("bucket_path.sdf");
  heightfield::Ground dug = heightfield::make_ground(scene);
  std::vector<heightfield::SoilLayer> taken;
  dug.take_above(20, 20, dug.height(20, 20) - 0.3, taken);
  write(folder / "dug.snapshot", scene, dug);
  SnapshotHead head;
  const heightfield::Ground loaded = load_ground(scene, folder / "dug.snapshot", &head);
  EXPECT_EQ(hash_of(loaded).digest(), hash_of(dug).digest());
  EXPECT_EQ(loaded.height(20, 20), dug.height(20, 20));
  EXPECT_EQ(head.steps, 250u);
  EXPECT_EQ(head.dt, 0.001);
}

TEST(Snapshot, OfAnotherSceneIsRefusedByItsName) {
  const test::Folder folder;
  const scene::Scene scene = testing::load("bucket_path.sdf");
  heightfield::Ground ground = heightfield::make_ground(scene);
  write(folder / "bucket.snapshot", scene, ground);
  try {
    load_ground(testing::load("block_collapse.sdf"), folder / "bucket.snapshot");
    FAIL() << "a snapshot of another scene was accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("bucket.snapshot"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("'block_collapse'"), std::string::npos)
        << error.what();
  }
  EXPECT_THROW(load_ground(scene, folder / "none.snapshot"), FileError);
}

/// Each of the three alone, changed by the smallest amount that affects a run.
TEST(Snapshot, OfAnotherMassCohesionOrPlaceIsRefusedWithTheDifference) {
  const test::Folder folder;
  const scene::Scene scene = testing::load("bucket_path.sdf");
  heightfield::Ground ground = heightfield::make_ground(scene);
  write(folder / "bucket.snapshot", scene, ground);
  const auto refusal = [&](const scene::Scene& here) {
    try {
      load_ground(here, folder / "bucket.snapshot");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refusal(scene), "");
  scene::Scene heavier = scene;
  ASSERT_FALSE(heavier.machines.at(0).machine.links.empty());
  heavier.machines[0].machine.links.back().mass += 1;
  scene::Scene stronger = scene;
  stronger.soils.at(0).cohesion += 1;
  scene::Scene aside = scene;
  aside.machines.at(0).X_WM.translation().x() += 0.001;
  const std::string link = heavier.machines[0].machine.links.back().name;
  for (const auto& [here, told] : {std::pair(&heavier, "link[" + link + "]/mass"),
                                   std::pair(&stronger, std::string("soil[loam]/cohesion")),
                                   std::pair(&aside, std::string("machine[bucket]/pose/place"))}) {
    const std::string said = refusal(*here);
    EXPECT_NE(said.find(told), std::string::npos) << told << ": " << said;
    EXPECT_NE(said.find("--resume-anyway"), std::string::npos) << said;
  }
}

}  // namespace
}  // namespace navvy::sim
