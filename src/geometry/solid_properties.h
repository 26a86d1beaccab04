// SPDX-License-Identifier: Apache-2.0
// Volume, centre of mass and inertia of the space that a closed mesh encloses.
#pragma once

#include <string>

#include "geometry/triangle_mesh.h"

namespace navvy::geometry {

/// Volume, centre of mass and inertia of a homogeneous body with a density of 1 kg/m3, in its own
/// frame B. For a real body, multiply volume and inertia by the density.
struct SolidProperties {
  double volume = 0;           ///< volume [m3], positive
  Vec3 p_BCom = Vec3::Zero();  ///< position of the centre of mass in B [m]
  /// Inertia about the centre of mass in the axes of B [m5]; multiplied by a density, it is in kg
  /// m2. The off-diagonal entries are the negative products of inertia.
  Mat3 inertia = Mat3::Zero();
};

/// Computes the properties of the body that a closed mesh encloses, by exact sums over the
/// tetrahedra formed by the triangles and the centre of the bounding box. Errors are about 1e-15 of
/// the size of the box, independent of the body's position. Where two parts of the mesh overlap,
/// both volumes count; a part that faces inwards is a cavity and is subtracted.
/// @throws InputError naming the mesh by `name` if it is not valid, if an edge has a triangle on
/// only one side (vertices at the same position count as one), or if the volume is not positive
/// because the mesh is inside out or flat
SolidProperties solid_properties(const TriangleMesh& mesh, const std::string& name = "mesh");

}  // namespace navvy::geometry
