// SPDX-License-Identifier: Apache-2.0
// Rules for wheels, tracks and drives beyond the ranges of single fields.
#pragma once

#include "scene/machine.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Checks a <navvy:drive> whose fields were read: linkage, differentials and engine. Sets
/// Powertrain::engine_power for an engine that also drives the pump.
void finish_drive(Element& element, scene::Drive& drive, Faults& faults);

/// Sorts the rollers of each track from front to rear and checks its geometry: sprocket and idler
/// not below the lower run, rollers between sprocket and idler, and a differential drive. Joints,
/// links and drive must have been read.
void finish_tracks(Element& model, scene::Machine& machine, Faults& faults);

/// Checks the rules that the drive's type imposes on wheels and pump. `element` is the
/// <navvy:drive>. Joints, links and pump must have been read.
void check_wheels(const Element& element, const scene::Machine& machine, Faults& faults);

}  // namespace navvy::scene_io
