// SPDX-License-Identifier: Apache-2.0
// Machines of several files: a model that holds models.
#pragma once

#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Makes every <include> and <model> inside a <model> a part of that model, in place: its links,
/// joints, frames and extension elements stand there under names NAME::theirs, and a frame NAME
/// where it was put, so that a joint of the whole connects `tractor::chassis` with
/// `trailer::drawbar`. Parts may have parts themselves. What belongs to a machine by itself (its
/// place, its engine, whether it is static) is left out. Faults of a part tell its own file and
/// line, also later. Works on the models of the root and of a world. False after a fault.
bool assemble(Document& document, Faults& faults);

}  // namespace navvy::scene_io
