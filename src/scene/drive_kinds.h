// SPDX-License-Identifier: Apache-2.0
// Questions about the kind of a drive, so that no other module asks the variant itself.
#pragma once

#include <variant>

#include "scene/drive.h"

namespace navvy::scene {

/// Returns `drive` as a differential drive; null for the other types of drive.
inline const DifferentialDrive* differential_drive(const Drive& drive) {
  return std::get_if<DifferentialDrive>(&drive);
}

}  // namespace navvy::scene
