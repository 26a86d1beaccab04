// SPDX-License-Identifier: Apache-2.0
// Reduces meshes to few triangles, for pictures that must be small.
#pragma once

#include <cstddef>

#include "geometry/triangle_mesh.h"

namespace navvy::geometry {

/// Returns `mesh` with at most about `most` triangles, for looking at only: the result is neither
/// closed nor free of folds. A mesh with few enough triangles is returned as it is. The vertices in
/// each cube of a lattice become one, at their mean, and triangles without area are left out
/// [Rossignac 1993]; the cubes are made larger until few enough triangles are left. Triangles keep
/// their materials.
TriangleMesh simplified(const TriangleMesh& mesh, std::size_t most);

}  // namespace navvy::geometry
