// SPDX-License-Identifier: Apache-2.0
// The trench on real ground: maps that are not part of the tree. NAVVY_TEST_DATA names the folder
// that holds terrain/lidar_hummocky_1m.tif (hummocks, slopes to 36 degrees) and
// terrain/kootenai_channel_1m.asc (a river bank).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "control/step_kinds.h"
#include "paths.h"
#include "record/summary.h"
#include "validation/report.h"
#include "validation/scenes.h"

namespace navvy::validation {
namespace {

struct Spot {
  const char* name;
  const char* file;
  Vec2 at;  ///< middle of the site from the file's lower-left corner [m]
};
void PrintTo(const Spot& spot, std::ostream* out) { *out << spot.file; }
const Spot kSpots[] = {{"Hummocks", "lidar_hummocky_1m.tif", Vec2(200, 200)},
                       {"RiverBank", "kootenai_channel_1m.asc", Vec2(32, 14)}};

/// Returns the path of a map, empty if it is not on this machine.
std::string map_file(const std::string& name) {
  const char* given = std::getenv("NAVVY_TEST_DATA");
  const std::filesystem::path folder =
      given != nullptr ? given : navvy::source_dir() + "/../shared/data";
  const std::filesystem::path path = folder / "terrain" / name;
  return std::filesystem::exists(path) ? path.string() : "";
}

class RealTerrain : public testing::TestWithParam<Spot> {};

TEST_P(RealTerrain, DigsATrenchOfHalfTheLengthAndTheMassBalanceHolds) {
  const Spot& spot = GetParam();
  const std::string file = map_file(spot.file);
  if (file.empty())
    GTEST_SKIP() << spot.file << " is not here; set NAVVY_TEST_DATA to the folder of terrain/";
  scene_io::Overrides overrides;
  overrides.render = false;
  overrides.terrain = file;
  overrides.at = spot.at;
  overrides.at_is_local = true;
  overrides.set.push_back(scene_io::parse_setting("machine.program.dig.to_m=3.25 0"));
  const scene::Scene description = scene_io::load_scene(
      navvy::source_dir() + "/scenarios/trench.sdf", control::step_kinds(), overrides);
  session::Session session(description, shared_device());
  const heightfield::Ground& ground = session.world().ground();
  double fastest = 0, deepest = 0;
  while (!session.done()) {
    session.step();
    fastest = std::max(fastest, std::abs(session.world().machines().at(0).link(0).velocity().z()));
  }
  for (double s = 0; s <= 1.6; s += ground.cell()) {
    const Vec2i column = ground.column_at(3.25 + s, 0);
    deepest = std::max(deepest, ground.start_height(column.x(), column.y()) -
                                    ground.height(column.x(), column.y()));
  }
  const record::Earthwork earth = record::measure_earthwork(session.world());
  const char* source = "real terrain [docs/validation.md, Whole digs]";
  std::printf("%s: %zu cycles in %.0f s, bank %.2f m3, loose %.2f m3, most %d particles\n",
              spot.file, session.cycles().size(), session.world().time(), earth.bank_volume,
              earth.loose_volume, session.world().soil().counts().particles_peak);
  expect_between("the program's end [s]", session.world().time(), 10,
                 description.recording.duration - 1, source);
  expect_between("cycles", static_cast<double>(session.cycles().size()), 2, 30, source);
  expect_between("deepest on the line [m]", deepest, 0.7, 1.1, source);
  expect_between("bank volume [m3]", earth.bank_volume, 1.0, 6, source);
  expect_between("machine's vertical speed [m/s]", fastest, 0, 1.0, source);
  expect_between("ledger error [units]",
                 static_cast<double>(session.world().soil().mass_ledger().error), 0, 0, source);
  expect_between("shell crossings",
                 static_cast<double>(session.world().soil().counts().shell_crossings), 0, 0,
                 source);
}

INSTANTIATE_TEST_SUITE_P(Maps, RealTerrain, testing::ValuesIn(kSpots),
                         [](const testing::TestParamInfo<Spot>& spot) { return spot.param.name; });

}  // namespace
}  // namespace navvy::validation
