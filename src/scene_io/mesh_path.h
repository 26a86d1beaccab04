// SPDX-License-Identifier: Apache-2.0
// Paths of files that scenes name, and triangle meshes.
#pragma once

#include <string>

#include "scene/machine.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Returns the reason why there is no plain file at `path`: missing, a pipe, a device or a
/// directory.
std::string why_no_file(const std::string& path);

/// Finds the OBJ file that `uri` names: relative to the file that holds it, absolute, or
/// model://NAME/... below a vehicles/ directory. `path` becomes absolute. Reports a fault and
/// returns false if there is none.
bool resolve_mesh(const Element& uri, std::string& path, Faults& faults);

/// Checks that the OBJ file at `path` can be drawn or, if `solid`, collide by the hull of its
/// vertices. A file is read once for all that name it. Returns false after a fault.
bool check_mesh(const Element& uri, const std::string& path, bool solid, Faults& faults);

/// Finds the model file of an <include>'s `uri`: a file, a directory with model.sdf, or
/// model://NAME. Returns false after a fault.
bool resolve_model(const Element& uri, std::string& path, Faults& faults);

/// Reads the triangles of a shell from an OBJ file [m]. Reports a fault at `at`, with the line in
/// the OBJ file, and returns false if it cannot be read.
bool read_shell_mesh(const std::string& path, const Element& at, scene::Shell& shell,
                     Faults& faults);

}  // namespace navvy::scene_io
