// SPDX-License-Identifier: Apache-2.0
// The point of a tool at which its force is shown.
#pragma once

#include "scene/machine.h"

namespace navvy::record {

/// Returns the point of a tool, in its link's frame, at which its force is shown [m]: the middle of
/// a bucket's edge, else the mean of the shell's vertices.
Vec3 tool_point(const scene::Shell& shell);

}  // namespace navvy::record
