// SPDX-License-Identifier: Apache-2.0
// Triangles of the shapes of links, for beams.
#pragma once

#include "geometry/triangle_mesh.h"
#include "scene/machine.h"

namespace navvy::sensor {

/// Largest distance between a round shape and its triangles [m].
inline constexpr double kRoundness = 2e-4;

/// Returns the triangles of a shape in its own frame, with their fronts outwards. Round shapes get
/// as many triangles as kRoundness asks for.
/// @throws FileError or InputError for a mesh that cannot be read.
geometry::TriangleMesh mesh_of(const scene::Geometry& shape);

/// Appends the triangles of `part`, placed by X_AP, to `whole`, whose frame is A.
void append(const geometry::TriangleMesh& part, const Pose& X_AP, geometry::TriangleMesh& whole);

}  // namespace navvy::sensor
