// SPDX-License-Identifier: Apache-2.0
// Where files named in a scene lie, why one is none, and triangle meshes of shells.
#pragma once

#include <string>

#include "scene/machine.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Why there is no plain file at `path`, for a message: a pipe, device or folder is told as what it
/// is.
std::string why_no_file(const std::string& path);

/// Absolute path of the OBJ file named by `uri`: relative to the file that holds it, absolute, or
/// model://NAME/... below a vehicles/ directory. Reports a fault and answers false when there is
/// none. The path leads there from any working directory.
bool resolve_mesh(const Element& uri, std::string& path, Faults& faults);

/// Reads the OBJ file at `path` to see that it can be drawn or, if `solid`, collide by the hull of
/// its vertices: what is found wrong here would end a run at its start. A file is read once for all
/// that name it. False after a fault.
bool check_mesh(const Element& uri, const std::string& path, bool solid, Faults& faults);

/// The model file named by an <include>'s `uri`: a file, a directory with model.sdf, or
/// model://NAME.
bool resolve_model(const Element& uri, std::string& path, Faults& faults);

/// Gives `shell` the triangles of an OBJ file [m]. Reports a fault at `at`, with the OBJ file's own
/// line, and answers false when it cannot be read.
bool read_shell_mesh(const std::string& path, const Element& at, scene::Shell& shell,
                     Faults& faults);

}  // namespace navvy::scene_io
