// SPDX-License-Identifier: Apache-2.0
#include "scene/scaled_mesh.h"

#include "geometry/read_mesh.h"

namespace navvy::scene {

geometry::TriangleMesh scaled_mesh(const Geometry& shape) {
  geometry::TriangleMesh out = shape.made ? *shape.made : geometry::read_mesh(shape.mesh_file);
  for (Vec3& v : out.vertices) v = v.cwiseProduct(shape.scale);
  return out;
}

}  // namespace navvy::scene
