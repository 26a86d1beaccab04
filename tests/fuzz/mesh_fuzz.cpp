// SPDX-License-Identifier: Apache-2.0
// Takes bytes as an STL, Collada, glTF, Inventor or VRML file; the first byte chooses the format.
// The reader refuses it with InputError, or all of geometry can handle the mesh.
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "core/error.h"
#include "geometry/read_mesh.h"
#include "geometry/topology.h"
#include "target.h"

NAVVY_FUZZ_TARGET(mesh) {
  using namespace navvy::geometry;
  if (size == 0) return 0;
  const std::string endings[] = {".stl", ".dae", ".gltf", ".glb", ".iv", ".wrl"};
  // Readers choose by the ending, so the file needs a name; this folder is in memory.
  const std::string path =
      "/dev/shm/navvy_mesh_fuzz_" + std::to_string(::getpid()) + endings[data[0] % 6];
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(data + 1), static_cast<std::streamsize>(size - 1));
  try {
    const TriangleMesh mesh = read_mesh(path);
    navvy::fuzz::hold(!mesh.triangles.empty());
    is_solid(mesh);
    find_winding_clash(mesh);
  } catch (const navvy::InputError&) {
  }
  std::filesystem::remove(path);
  return 0;
}
