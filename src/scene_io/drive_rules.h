// SPDX-License-Identifier: Apache-2.0
// Rules for wheels, tracks and drives beyond the ranges of single fields.
#pragma once

#include "scene/machine.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Checks the linkage, differentials and engine of a drive after it has been read from `element`, a
/// <navvy:drive>, and sets `engine_power` if the engine also drives the pump.
void finish_drive(Element& element, scene::Drive& drive, Faults& faults);

/// Sorts the rollers of every track from front to rear, then checks the conditions for tracks: the
/// sprocket is above the lower run, there are rollers between sprocket and idler, and the machine
/// has a differential drive. The joints, links and drive of `machine` must have been read.
void finish_tracks(Element& model, scene::Machine& machine, Faults& faults);

/// Checks that the wheels and the pump meet the conditions of the drive's type. `element` is the
/// <navvy:drive>, at which errors are reported. The joints, links and pump of `machine` must have
/// been read.
void check_wheels(const Element& element, const scene::Machine& machine, Faults& faults);

}  // namespace navvy::scene_io
