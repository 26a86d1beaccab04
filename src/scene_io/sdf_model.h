// SPDX-License-Identifier: Apache-2.0
// Reads the links and joints of an SDF model. Only this file and sdf_schema use libsdformat.
#pragma once

#include "scene/machine.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Reads links, inertias, shapes and joints of a <model> into `machine` through libsdformat, which
/// resolves frames and relative poses. The links are ordered as a tree: the base first and every
/// parent before its children; the child of joint i is link i + 1. A fixed joint to the world sets
/// `fixed_base`. `check_sdf` must have found no error. Errors that only libsdformat finds are
/// reported at the element that their message names. Returns false after an error.
bool read_sdf_model(const Element& model, scene::Machine& machine, Faults& faults);

}  // namespace navvy::scene_io
