// SPDX-License-Identifier: Apache-2.0
// Takes bytes as a terrain map. The importer may refuse them with InputError only.
#include <sys/mman.h>
#include <unistd.h>

#include <string>

#include "core/error.h"
#include "heightfield/make_ground.h"
#include "target.h"

NAVVY_FUZZ_TARGET(terrain) {
  if (size < 1) return 0;
  // The first byte selects the place in the map and the cell; the driver is chosen by content.
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
  try {
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
