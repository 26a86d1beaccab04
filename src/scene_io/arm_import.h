// SPDX-License-Identifier: Apache-2.0
// Gives the arm of an imported machine its roles, bucket and drives.
#pragma once

#include <string>
#include <vector>

#include "scene/machine.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Finds the arm of `machine` and writes it into `model`, from which the machine was read: roles of
/// its joints, axes that point as digging expects, the shell and cutting edge of the bucket by the
/// bucket's mesh, torques and speeds where the file has placeholders, and cylinders that fit the
/// limits of the joints; torques and cylinders only if the machine is `weighed`, without
/// placeholders among its masses. `machine` is changed alike. Returns a sentence about each thing
/// that was made, assumed or not recognised.
std::vector<std::string> import_arm(Document& document, Element& model, scene::Machine& machine,
                                    bool weighed);

}  // namespace navvy::scene_io
