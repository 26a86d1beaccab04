// SPDX-License-Identifier: Apache-2.0
// Volume, centre of mass and inertia of the space that a closed mesh encloses.
#pragma once

#include <string>

#include "geometry/triangle_mesh.h"

namespace navvy::geometry {

/// A homogeneous body of 1 kg/m3 in the mesh's own frame B: multiply by a density for a real one.
struct SolidProperties {
  double volume = 0;           ///< [m3], positive
  Vec3 p_BCom = Vec3::Zero();  ///< centre of mass [m]
  /// About the centre of mass, axes of B [m5]; times density [kg m2]; products negative.
  Mat3 inertia = Mat3::Zero();
};

/// Exact sums over the tetrahedra between the triangles and the middle of the mesh's box, in
/// double: errors stay at some 1e-15 of the size of the box, wherever the body lies. Space that two
/// pieces share counts twice, space inside a piece that is turned inwards (a cavity) does not
/// count.
/// @throws InputError naming `name` when the mesh is not valid, when an edge has no triangle on its
/// other side (vertices at one place count as one), or when the volume is not positive: the mesh is
/// inside out or flat.
SolidProperties solid_properties(const TriangleMesh& mesh, const std::string& name = "mesh");

}  // namespace navvy::geometry
