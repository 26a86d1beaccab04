// SPDX-License-Identifier: Apache-2.0
// Timing of soil steps on a site: what all rows of the particle soil share.
#pragma once

#include <memory>
#include <vector>

#include "bench/row.h"
#include "lab/lab_site.h"

namespace navvy::device {
class Device;
}

namespace navvy::bench {

/// Times `steps` steps from the present state of `site`, several times from the same state, and
/// returns the row without name, device and peaks. `motions`: tools, which keep their velocities.
Row time_steps(device::Device& device, lab::Site& site, int steps,
               const std::vector<soil::ToolMotion>& motions = {});

/// Returns a block of `soil` with edges of `edge` [m] on level ground, in cells of 0.1 m with eight
/// particles each, 0.1 s after its walls have gone.
std::unique_ptr<lab::Site> collapsing_block(device::Device& device, const scene::Soil& soil,
                                            double edge);

}  // namespace navvy::bench
