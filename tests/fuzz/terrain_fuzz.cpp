// SPDX-License-Identifier: Apache-2.0
// Takes bytes as a terrain map. The importer may refuse them with InputError only. Some choices
// take the readers that need no GDAL, and the bytes also as the CRS beside a map.
#include <sys/mman.h>
#include <unistd.h>

#include <string>

#include "core/error.h"
#include "heightfield/make_ground.h"
#include "heightfield/map_files/import.h"
#include "heightfield/map_files/side_files.h"
#include "target.h"

namespace {

// Reads the map with the readers that need no GDAL. An accepted map must have heights.
void read_plain(const navvy::scene::Scene& world) {
  navvy::heightfield::Ground::Setup setup;
  setup.cell = world.solver.cell;
  setup.nx = 8, setup.ny = 4;
  // Few cells in memory, so that windows are read, too.
  navvy::heightfield::import_terrain(world, setup, 100, 16, navvy::heightfield::MapReader::kPlain);
  for (int iy = 0; iy < setup.ny; ++iy)
    for (int ix = 0; ix < setup.nx; ++ix)
      navvy::fuzz::hold(setup.surface(ix, iy) + 1 > setup.datum);
}

}  // namespace

NAVVY_FUZZ_TARGET(terrain) {
  if (size < 1) return 0;
  // The first byte selects the place in the map, the cell and the reader; the format is found by
  // content.
  const std::uint8_t choice = data[0];
  const int file = ::memfd_create("map", 0);
  if (file < 0) return 0;
  const std::string path = "/proc/self/fd/" + std::to_string(file);
  if (::write(file, data + 1, size - 1) != static_cast<ssize_t>(size - 1)) {
    ::close(file);
    return 0;
  }
  navvy::scene::Scene world;
  world.soils.resize(1);
  world.soils[0].name = "loam";
  world.ground.layers = {{"loam", 1}};
  world.ground.file = path;
  // Few columns: the target tests reading, not the filling of gaps.
  world.ground.size = navvy::Vec2(0.8, 0.4);
  world.solver.cell = (choice & 1) != 0 ? 0.2 : 0.1;
  world.ground.has_at = world.ground.at_is_local = (choice & 2) != 0;
  world.ground.at = navvy::Vec2(2, 1);
  if ((choice & 4) != 0) world.ground.steep = navvy::scene::SteepGround::kSettle;
  // Pictures and arrays need these two.
  if ((choice & 16) != 0) world.ground.scale.cell = 0.5;
  if ((choice & 32) != 0) world.ground.scale.has_heights = true, world.ground.scale.high = 5;
  try {
    if ((choice & 8) != 0) {
      navvy::heightfield::parse_crs(std::string(reinterpret_cast<const char*>(data), size));
      read_plain(world);
      ::close(file);
      return 0;
    }
    const navvy::heightfield::Ground ground = navvy::heightfield::make_ground(world);
    // An accepted map must be usable.
    for (int iy = 0; iy < ground.ny(); ++iy)
      for (int ix = 0; ix < ground.nx(); ++ix)
        if (!(ground.height(ix, iy) >= ground.datum())) std::abort();
  } catch (const navvy::InputError&) {
  }
  ::close(file);
  return 0;
}
