// SPDX-License-Identifier: Apache-2.0
// Reader of Wavefront OBJ files.
#pragma once

#include <string>

#include "geometry/triangle_mesh.h"

namespace navvy::geometry {

/// Reads a mesh from an OBJ file, in the file's own frame [m], with the materials of its MTL files.
///
/// All vertices are kept in the file's order and in single precision, whether a face uses them or
/// not, so that shells, pictures and collision hulls use the same points. Faces of more than three
/// corners are cut into triangles. Groups and objects are merged; lines, loose points, normals and
/// texture coordinates are ignored. A missing MTL file is logged as a warning, and its faces have
/// no material.
/// @throws FileError if the file cannot be read.
/// @throws InputError naming file and line for a vertex that is not three finite numbers, a face
/// that has fewer than three corners or names a vertex that does not exist, and for a file beyond
/// the limits of core/limits.h.
TriangleMesh read_obj(const std::string& path);

}  // namespace navvy::geometry
