// SPDX-License-Identifier: Apache-2.0
// Links and joints of an SDF model. Only this file and sdf_schema include libsdformat.
#pragma once

#include "scene/machine.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Reads links, inertias, shapes and joints of a <model> through libsdformat, which resolves frames
/// and relative poses. The links become a tree, base first and every parent before its children;
/// joint i moves link i + 1. A fixed joint to the world sets `fixed_base`. `check_sdf` must have
/// found no fault. Faults that only libsdformat finds are reported at the element they name.
/// Returns false after a fault.
bool read_sdf_model(const Element& model, scene::Machine& machine, Faults& faults);

}  // namespace navvy::scene_io
