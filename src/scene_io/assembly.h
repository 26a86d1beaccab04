// SPDX-License-Identifier: Apache-2.0
// Machines of several files: a model that holds models.
#pragma once

#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Makes every <include> and <model> inside a <model> a part of that model, in place. The elements
/// of a part NAME get names NAME::theirs, and a frame NAME is at its pose, so that a joint of the
/// whole can connect `tractor::chassis` with `trailer::drawbar`. Parts may have parts. Elements
/// that concern a machine as a whole (pose, physics, static) are dropped from parts. Faults of a
/// part are reported in its own file, also later. Works on the models of the root and of a world.
/// Returns false after a fault.
bool assemble(Document& document, Faults& faults);

}  // namespace navvy::scene_io
