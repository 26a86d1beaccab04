// SPDX-License-Identifier: Apache-2.0
// Shapes of hydraulic cylinders and of the linkages of buckets, for pictures and sensors.
#pragma once

#include <vector>

#include "scene/frame.h"
#include "sim/world.h"

namespace navvy::sim {

/// Appends to `out` all hydraulic cylinders of the machine with index `machine` at their present
/// lengths, side by side where a cylinder stands for several, and the bars of bucket linkages.
void add_cylinder_shapes(const World& world, int machine, std::vector<scene::FrameCylinder>& out);

}  // namespace navvy::sim
