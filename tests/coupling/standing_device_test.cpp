// SPDX-License-Identifier: Apache-2.0
// A stone with a shell on loam stays in place, both on active soil and after that soil was
// deposited in columns.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "control/step_kinds.h"
#include "device/device.h"
#include "folder.h"
#include "scene_io/loader.h"
#include "sim/world.h"
#include "values.h"

namespace navvy::coupling {
namespace {

/// 468 kg on 0.36 m2: loam supports ten times as much. `collision`: whether it also touches columns
/// as rigid bodies do.
scene::Scene stone_on_loam(bool collision) {
  const std::string box =
      "<pose>0 0 0.25 0 0 0</pose><geometry><box><size>0.6 0.6 0.5</size></box></geometry>";
  const test::Folder folder;
  const std::string file = folder / "stone.sdf";
  std::ofstream(file)
      << R"(<sdf version="1.9" xmlns:navvy="navvy"><world name="stone"><navvy:soil ref="loam"/>
<navvy:ground><size_m>6 6</size_m><depth_m>1.5</depth_m></navvy:ground>
<model name="stone"><pose>0.03 0.02 0 0 0 0</pose><link name="stone"><inertial><pose>0 0 0.25 0 0 0</pose><mass>468</mass>
<inertia><ixx>23.8</ixx><iyy>23.8</iyy><izz>28.1</izz></inertia></inertial><visual name="v">)"
      << box << "</visual>" << (collision ? "<collision name=\"c\">" + box + "</collision>" : "")
      << R"(</link>
<navvy:shell name="stone"><link>stone</link>
<vertices_m>-0.3 -0.3 0 -0.3 -0.3 0.5 -0.3 0.3 0 -0.3 0.3 0.5 0.3 -0.3 0 0.3 -0.3 0.5 0.3 0.3 0 0.3 0.3 0.5</vertices_m>
<triangles>0 1 3  0 3 2  4 6 7  4 7 5  0 4 5  0 5 1  2 3 7  2 7 6  0 2 6  0 6 4  1 5 7  1 7 3</triangles>
</navvy:shell></model></world></sdf>)";
  return scene_io::load_scene(file, control::step_kinds());
}

TEST(Standing, AStoneWithAShellSinksLessThanAMillimetreInTenSeconds) {
  for (const bool collision : {false, true}) {
    const scene::Scene scene = stone_on_loam(collision);
    device::Device device;
    sim::World world(scene, device);
    const auto height = [&] { return world.machines().at(0).link(0).pose().translation().z(); };
    // Its soil is active at first: it must rest on that, too. A regression made it fall by one
    // step's weight in every step, 16 mm/s.
    while (world.time() < 1) world.step();
    const double active = height();
    while (world.time() < 1.5) world.step();
    EXPECT_NEAR(height(), active, 5e-4) << "[m] in half a second";
    while (world.time() < 15) world.step();
    const double before = height();
    while (world.time() < 25) world.step();
    print_value("a stone on loam sinks in 10 s [mm]", 1e3 * (before - height()), "< 1",
                "docs/tools.md, resting contact");
    EXPECT_NEAR(height(), before, 1e-3);
    EXPECT_NEAR(height(), 0, 0.05) << "half a cell";
    EXPECT_EQ(world.soil().mass_ledger().error, 0);
  }
}

}  // namespace
}  // namespace navvy::coupling
