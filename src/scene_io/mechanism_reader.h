// SPDX-License-Identifier: Apache-2.0
// Reads what couples the joints of a machine: fixed ratios, springs, closed loops.
#pragma once

#include <vector>

#include "scene/machine.h"
#include "scene_io/sdf_model.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Reads the fixed ratios between joints into `machine.gears`: <mimic> in the <axis> of a joint,
/// and the joints of SDF's type gearbox. Links and joints have been read before. Reports ratios
/// that are no numbers or zero, joints that follow themselves, directly or through others, and
/// gearboxes without shafts.
void read_gears(const Element& model, const std::vector<Gearbox>& gearboxes,
                scene::Machine& machine, Faults& faults);

/// Decides which joints are passive where the file does not say so, and reports springs and
/// commands where they have no effect: on joints that follow others and on joints that close loops.
/// The machine's extension elements have been read before.
void finish_mechanisms(Element& model, scene::Machine& machine, Faults& faults);

/// Moves the positions at the start of joints that follow others and of passive joints in loops to
/// where the other joints demand. `positions` has been read from the <navvy:joint> children of
/// `parent`. Reports a loop that stays open, and positions beyond limits.
void close_at_start(Element& parent, const std::vector<scene::InitialPosition>& positions,
                    scene::Machine& machine, Faults& faults);

}  // namespace navvy::scene_io
