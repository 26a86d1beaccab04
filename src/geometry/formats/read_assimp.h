// SPDX-License-Identifier: Apache-2.0
// Reader of STL, Collada and glTF files.
#pragma once

#include <string>

#include "geometry/triangle_mesh.h"

namespace navvy::geometry {

/// Returns the mesh in an STL, DAE, glTF or GLB file; see geometry/read_mesh.h. Buffers that a glTF
/// file names are opened only in its folder and below. @throws as read_mesh
TriangleMesh read_assimp(const std::string& path);

}  // namespace navvy::geometry
