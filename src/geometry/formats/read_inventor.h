// SPDX-License-Identifier: Apache-2.0
// Reader of Open Inventor and VRML files.
#pragma once

#include <string>

#include "geometry/triangle_mesh.h"

namespace navvy::geometry {

/// Returns the mesh in an Open Inventor 2.1, VRML 1 or VRML97 file; see geometry/read_mesh.h.
/// Spheres, cylinders and other curved shapes become triangles. Coin runs in a child process, see
/// geometry/formats/read_in_child.h. @throws as read_mesh
TriangleMesh read_inventor(const std::string& path);

}  // namespace navvy::geometry
