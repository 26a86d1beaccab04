// SPDX-License-Identifier: Apache-2.0
// State of the coupling between steps: tool forces, ruts, and the ground that rigid bodies touch.
#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "control/step_kinds.h"
#include "core/error.h"
#include "core/saved_state.h"
#include "device/device.h"
#include "flip_bytes.h"
#include "paths.h"
#include "scene_io/loader.h"
#include "sim/world.h"
#include "sim/world_parts.h"

namespace navvy::coupling {
namespace {

/// Returns the shipped excavator on columns of 0.4 m: a patch of some 2000 heights, every byte of
/// which is flipped.
scene::Scene coarse_site() {
  scene::Scene world =
      scene_io::load_scene(navvy::source_dir() + "/scenarios/trench.sdf", control::step_kinds());
  world.solver.cell = 0.4;
  world.machines.at(0).program = {};
  return world;
}

class CouplingState : public ::testing::Test {
 protected:
  CouplingState() : world_(coarse_site(), device_), other_(coarse_site(), device_) {
    world_.commands().set(world_.machines().at(0), {0.8, 0, false});
    // Longer than the periods of the ground checks and of rut pressing.
    for (int i = 0; i < 40; ++i) world_.step();
  }
  Coupling& coupling() { return sim::parts(world_).coupling; }
  Coupling& target() { return sim::parts(other_).coupling; }
  std::string fault_of(const std::vector<char>& bytes) {
    try {
      load_saved(bytes, target());
    } catch (const InputError& error) {
      return error.what();
    }
    return "no fault";
  }

  device::Device device_;
  sim::World world_, other_;
};

TEST_F(CouplingState, HashesEveryByteItSaves) {
  ByteMap map;
  saved(coupling(), &map);
  std::size_t ruts = 0;
  for (const ByteMap::Field& field : map.fields)
    ruts += field.path.find("memory[") != std::string::npos;
  EXPECT_GT(ruts, 0u) << "the machine has made no ruts";
  EXPECT_EQ(test::flip_every_byte(coupling(), target()), "");
}

TEST_F(CouplingState, IsLoadedAsItWasSaved) {
  const std::vector<char> bytes = saved(coupling());
  load_saved(bytes, target());
  EXPECT_EQ(saved(target()), bytes);
  ASSERT_FALSE(target().tools().empty());
  for (std::size_t t = 0; t < target().tools().size(); ++t) {
    EXPECT_EQ(target().tools()[t].force_W, coupling().tools()[t].force_W);
    EXPECT_EQ(target().tools()[t].tool, coupling().tools()[t].tool);
  }
}

}  // namespace
}  // namespace navvy::coupling
