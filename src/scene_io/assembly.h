// SPDX-License-Identifier: Apache-2.0
// Merges models that contain other models into one machine.
#pragma once

#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Merges every <include> and <model> inside a <model> into that outer model, changing `document`.
/// Elements of a part NAME are renamed to NAME::their_name, and a frame NAME is added at the pose
/// of the part, so that a joint of the outer model can connect, for example, `tractor::chassis`
/// with `trailer::drawbar`. Parts may contain parts. Elements that concern a machine as a whole
/// (pose, physics, static) are dropped from parts. Errors in a part are reported with the name and
/// line of the part's own file, by later checks too. The function handles the models at the root
/// and those of a world. Returns false after an error.
bool assemble(Document& document, Faults& faults);

}  // namespace navvy::scene_io
