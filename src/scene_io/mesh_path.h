// SPDX-License-Identifier: Apache-2.0
// Finds the files that scenes name, and checks and reads triangle meshes.
#pragma once

#include <string>

#include "scene/machine.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Returns the reason why `path` is not a regular file: missing, a pipe, a device or a directory.
std::string why_no_file(const std::string& path);

/// Finds the mesh file that the element `uri` names: relative to the file that contains the
/// element, absolute, model://NAME/... in a vehicles/ directory, or model:// and package:// on the
/// search path (docs/import.md). Stores its absolute path in `path`. Reports an error and returns
/// false if there is no such file.
bool resolve_mesh(const Element& uri, std::string& path, Faults& faults);

/// Checks that the mesh file at `path` can be drawn. If `solid`, it also checks that the convex
/// hull of its vertices can be used as a collision shape. A file is read only once, even if several
/// elements name it. Errors are reported at `uri`; returns false after an error.
bool check_mesh(const Element& uri, const std::string& path, bool solid, Faults& faults);

/// Finds the model file that the <uri> of an <include> names: a file, a directory with model.sdf,
/// or model://NAME. Stores its path in `path`. Returns false after an error.
bool resolve_model(const Element& uri, std::string& path, Faults& faults);

/// Reads the triangles of a shell from a mesh file [m]. If the file cannot be read, reports an
/// error at the element `at`, with the line in that file, and returns false.
bool read_shell_mesh(const std::string& path, const Element& at, scene::Shell& shell,
                     Faults& faults);

}  // namespace navvy::scene_io
