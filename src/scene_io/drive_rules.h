// SPDX-License-Identifier: Apache-2.0
// Rules for wheels, tracks and drives beyond the ranges of single fields.
#pragma once

#include "scene/machine.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Checks a <navvy:drive> after it was read: linkage, differentials and engine. Sets the power that
/// an engine shares with the pump.
void finish_drive(Element& element, scene::Drive& drive, Faults& faults);

/// Sorts the rollers of every track, then checks what tracks need of the machine: a sprocket above
/// the lower run, within it or beyond, rollers between, and a differential drive. Joints, links and
/// drive are known.
void finish_tracks(Element& model, scene::Machine& machine, Faults& faults);

/// Checks what the kind of drive needs of wheels and pump. Joints, links and pump are known.
void check_wheels(const Element& element, const scene::Machine& machine, Faults& faults);

}  // namespace navvy::scene_io
