// SPDX-License-Identifier: Apache-2.0
// Layers and a patch of a third soil in one scene, dug through by one scoop: every soil has its own
// ledger.
#include <gtest/gtest.h>

#include "control/step_kinds.h"
#include "core/file.h"
#include "device/device.h"
#include "paths.h"
#include "record/summary.h"
#include "scene_io/loader.h"
#include "session/session.h"
#include "sim/world_terrain.h"
#include "values.h"

namespace navvy::session {
namespace {

void replace(std::string& text, const std::string& what, const std::string& with) {
  const std::size_t at = text.find(what);
  ASSERT_NE(at, std::string::npos) << what;
  text.replace(at, what.size(), with);
}

/// Returns bucket_path.sdf on topsoil over loam, with a patch of sand under the second half of the
/// scoop and half its width.
scene::Scene patched_scene() {
  const std::string path = navvy::source_dir() + "/scenarios/bucket_path.sdf";
  const std::vector<char> file = read_file(path);
  std::string text(file.begin(), file.end());
  replace(text, R"(<navvy:soil ref="loam"/>)",
          R"(<navvy:soil ref="topsoil"/><navvy:soil ref="loam"/><navvy:soil ref="sand_dry"/>)");
  replace(text, "<depth_m>1.5</depth_m>",
          R"(<depth_m>1.5</depth_m>
             <layer><soil>topsoil</soil><thickness_m>0.15</thickness_m></layer><layer><soil>loam</soil></layer>
             <patch><min_m>-0.6 0</min_m><max_m>1.2 2</max_m><layer><soil>sand_dry</soil></layer></patch>)");
  scene_io::Overrides overrides;
  overrides.render = false;
  return scene_io::load_scene_from_string(text, path, control::step_kinds(), overrides);
}

TEST(SessionWithPatches, HasALedgerPerSoilOfLayersAndPatch) {
  device::Device device;
  Session session(patched_scene(), device);
  const sim::World& world = session.world();
  std::vector<double> active(3, 0.0);  // largest active mass [kg]
  while (!session.done()) {
    session.step();
    const sim::MassLedger ledger = world.soil().mass_ledger();
    for (std::size_t i = 0; i < 3; ++i) {
      ASSERT_EQ(ledger.columns[i] + ledger.particles[i] + ledger.left_site[i] - ledger.inserted[i],
                0);
      active[i] = std::max(active[i], kilograms(ledger.particles[i]));
    }
  }
  const record::Earthwork earth =
      record::measure_earthwork(world, sim::active_places(world).on_ground);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string name = world.description().soils.at(i).name;
    const double ratio = earth.soils.at(i).spoil / earth.soils[i].dug;
    print_value(name + ": dug [kg]", earth.soils[i].dug, "> 50", "ledger per soil");
    print_value(name + ": spoil / dug", ratio, "1 +-1 %", "ledger per soil");
    EXPECT_GT(active[i], 0) << name;
    // The total is about 700 kg: the scoop cut through each.
    EXPECT_GT(earth.soils[i].dug, 50) << name;
    EXPECT_NEAR(ratio, 1, 0.01) << name;  // particles that fell back into the cut are neither
  }
}

}  // namespace
}  // namespace navvy::session
