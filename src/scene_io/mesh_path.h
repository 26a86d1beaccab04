// SPDX-License-Identifier: Apache-2.0
// Where files named in a scene lie, and triangle meshes of shells.
#pragma once

#include <string>

#include "scene/machine.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Absolute path of the OBJ file named by `uri`: relative to the file that holds it, absolute, or model://NAME/...
/// below a vehicles/ directory. Reports a fault and answers false when there is none. The path leads there from any
/// working directory.
bool resolve_mesh(const Element& uri, std::string& path, Faults& faults);

/// The model file named by an <include>'s `uri`: a file, a directory with model.sdf, or model://NAME.
bool resolve_model(const Element& uri, std::string& path, Faults& faults);

/// Triangles of an OBJ file [m]; faces with more corners are split. `at` is blamed for faults.
bool read_obj(const std::string& path, const Element& at, scene::Shell& shell, Faults& faults);

}  // namespace navvy::scene_io
