// SPDX-License-Identifier: Apache-2.0
// The engine of a drive and its gears.
#pragma once

#include "scene/drive.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Reads the <engine> of a <navvy:drive> into `drive`, with the power that it shares with the pump.
void read_engine(Element& element, scene::AckermannDrive& drive, Faults& faults);

}  // namespace navvy::scene_io
