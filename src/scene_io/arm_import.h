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
/// placeholders among its masses. In `machine` the roles, the frames, axes, limits, starts, torques
/// and speeds of the arm's joints and the collisions of the bucket's link change alike; what is
/// added to `model` (shell, bucket, cylinders) is in the file only. A bucket that the machine has
/// already is kept. Returns a sentence about each thing that was made, kept, assumed or not
/// recognised.
std::vector<std::string> import_arm(Document& document, Element& model, scene::Machine& machine,
                                    bool weighed);

}  // namespace navvy::scene_io
