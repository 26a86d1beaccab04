// SPDX-License-Identifier: Apache-2.0
// Takes bytes as a LandXML file, then lays its surface on a small site. Both may refuse with
// InputError only.
#include <sys/mman.h>
#include <unistd.h>

#include <cmath>
#include <string>

#include "core/error.h"
#include "heightfield/design_surface.h"
#include "heightfield/make_ground.h"
#include "scene_io/landxml.h"
#include "target.h"

NAVVY_FUZZ_TARGET(landxml) {
  const int file = ::memfd_create("landxml", 0);
  if (file < 0) return 0;
  const std::string path = "/proc/self/fd/" + std::to_string(file);
  if (::write(file, data, size) == static_cast<ssize_t>(size)) {
    navvy::scene_io::Faults faults;
    const auto tin = navvy::scene_io::read_landxml(path, "", faults);
    navvy::fuzz::hold((tin == nullptr) == faults.has_errors());
    navvy::scene::Scene world;
    world.soils.resize(1);
    world.soils[0].name = "loam";
    world.ground.layers = {{"loam", 1}};
    world.ground.size = navvy::Vec2(4, 3);
    world.design.file = path;
    world.design.tin = tin;
    try {
      if (tin != nullptr) {
        const auto design =
            navvy::heightfield::make_design(world, navvy::heightfield::make_ground(world));
        for (const float z : design->z) navvy::fuzz::hold(!std::isinf(z));
      }
    } catch (const navvy::InputError&) {
    }
  }
  ::close(file);
  return 0;
}
