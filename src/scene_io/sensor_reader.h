// SPDX-License-Identifier: Apache-2.0
// Reads the <sensor> elements of a machine's links.
#pragma once

#include "scene/scene.h"
#include "scene_io/element_reader.h"

namespace navvy::scene_io {

/// Reads the sensors of all links of `model` into the links of `machine`, which have been read
/// together with the machine's extensions, and checks them. Sensors of SDF that Navvy does not
/// simulate are reported as ignored.
void read_sensors(Element& model, const Names& names, scene::Machine& machine, Faults& faults);

/// Moves the sensors that a scene adds to a machine (`instance.sensors`, which were read from the
/// <navvy:sensor> children of `element`) to their links, and checks them.
void add_sensors(Element& element, scene::MachineInWorld& instance, Faults& faults);

/// Copies the elements of the preset that a <sensor> names and that are missing in it into the
/// element. A preset is a file sensors/NAME.sdf in a data directory, or a path that ends in .sdf
/// and counts from the file of the sensor. Has no effect without a preset.
void fill_in_preset(Element& sensor, Faults& faults);

}  // namespace navvy::scene_io
