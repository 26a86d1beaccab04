// SPDX-License-Identifier: Apache-2.0
// Wheels and the drive that turns them.
#pragma once

#include "scene/machine.h"
#include "scene_io/machine_names.h"

namespace navvy::scene_io {

/// Reads a <navvy:wheel>.
scene::Wheel read_wheel(Element& element, const Names& names, Faults& faults);

/// Reads a <navvy:track>: the sprocket of a crawler's belt, as a driven wheel.
scene::Wheel read_track(Element& element, const Names& names, Faults& faults);

/// What tracks ask of the machine: a sprocket above the lower run, within it or beyond, rollers
/// that lie between, and a drive that steers by them. Joints, links and drive are known.
void check_tracks(Element& model, const scene::Machine& machine, Faults& faults);

/// The drive of the kind that `type` names, Ackermann without one.
scene::Drive read_drive(Element& element, Faults& faults);

/// What the kind of the machine's drive asks of its wheels, and a shared engine of its pump;
/// joints, links and pump are known.
void check_wheels(const Element& element, const scene::Machine& machine, Faults& faults);

}  // namespace navvy::scene_io
