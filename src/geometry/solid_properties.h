// SPDX-License-Identifier: Apache-2.0
// Volume, centre of mass and inertia of the space that a closed mesh encloses.
#pragma once

#include <string>

#include "geometry/triangle_mesh.h"

namespace navvy::geometry {

/// Properties of a homogeneous body of 1 kg/m3 in its own frame B; multiply by a density for a real
/// body.
struct SolidProperties {
  /// Volume [m3], positive.
  double volume = 0;
  /// Centre of mass [m].
  Vec3 p_BCom = Vec3::Zero();
  /// Inertia about the centre of mass in the axes of B [m5], or [kg m2] times a density.
  /// Off-diagonal entries are the negative products of inertia.
  Mat3 inertia = Mat3::Zero();
};

/// Computes volume, centre of mass and inertia by exact sums over the tetrahedra between the
/// triangles and the centre of the mesh's box. Errors are about 1e-15 of the box's size, wherever
/// the body is. Space that two pieces share counts twice; space inside a piece that is turned
/// inwards (a cavity) does not count.
/// @throws InputError naming `name` if the mesh is not valid, if an edge has no triangle on its
/// other side (vertices at one place count as one), or if the volume is not positive, i.e. the mesh
/// is inside out or flat.
SolidProperties solid_properties(const TriangleMesh& mesh, const std::string& name = "mesh");

}  // namespace navvy::geometry
