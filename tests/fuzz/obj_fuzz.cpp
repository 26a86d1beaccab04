// SPDX-License-Identifier: Apache-2.0
// Takes bytes as an OBJ file: the reader refuses it with InputError, or all of geometry can handle
// the mesh.
#include <sys/mman.h>
#include <unistd.h>

#include <string>

#include "core/error.h"
#include "geometry/hull.h"
#include "geometry/obj/read_obj.h"
#include "geometry/topology.h"
#include "target.h"

NAVVY_FUZZ_TARGET(obj) {
  using namespace navvy::geometry;
  const int file = ::memfd_create("mesh", 0);
  if (file < 0) return 0;
  if (::write(file, data, size) == static_cast<ssize_t>(size)) {
    try {
      const TriangleMesh mesh = read_obj("/proc/self/fd/" + std::to_string(file));
      is_solid(mesh);
      find_winding_clash(mesh);
      if (mesh.vertices.size() <= 500) convex_hull(mesh.vertices);
    } catch (const navvy::InputError&) {
    }
  }
  ::close(file);
  return 0;
}
