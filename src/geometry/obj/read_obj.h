// SPDX-License-Identifier: Apache-2.0
// Reader of Wavefront OBJ files.
#pragma once

#include <string>

#include "geometry/triangle_mesh.h"

namespace navvy::geometry {

/// Returns the mesh in an OBJ file, in the file's own frame with lengths taken as metres, and with
/// the materials of its MTL files.
///
/// All vertices are kept in the order of the file and in single precision, even those that no face
/// uses, so that shells, pictures and collision hulls use the same points. Faces with more than
/// three corners are divided into triangles. Groups and objects are merged; lines, loose points,
/// normals and texture coordinates are ignored. A missing MTL file is logged as a warning, and its
/// faces have no material.
/// @throws FileError if the file cannot be read
/// @throws InputError naming file and line for a vertex that does not have three finite numbers,
/// for a face that has fewer than three corners or refers to a nonexistent vertex, and for a file
/// that exceeds the limits of core/limits.h
TriangleMesh read_obj(const std::string& path);

}  // namespace navvy::geometry
