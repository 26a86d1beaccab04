// SPDX-License-Identifier: Apache-2.0
// Triangles of mesh shapes, wherever they come from.
#pragma once

#include "geometry/triangle_mesh.h"
#include "scene/machine.h"

namespace navvy::scene {

/// Returns the scaled triangles of a shape that is a mesh, in the shape's frame: those that were
/// computed, or those of its file. @throws FileError or InputError for a file that cannot be read.
geometry::TriangleMesh scaled_mesh(const Geometry& shape);

}  // namespace navvy::scene
