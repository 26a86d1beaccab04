// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "heightfield/layered_ground.h"

namespace navvy::heightfield::testing {

/// Volume between a ground and its start, from heights as a surveyor measures it [m3].
struct VolumeChange {
  /// Volume above the initial ground.
  double raised = 0;
  /// Volume below the initial ground, positive.
  double lowered = 0;
};

inline VolumeChange volume_change(const Ground& ground) {
  VolumeChange out;
  for (int iy = 0; iy < ground.ny(); ++iy)
    for (int ix = 0; ix < ground.nx(); ++ix) {
      const double rise = ground.height(ix, iy) - ground.start_height(ix, iy);
      (rise > 0 ? out.raised : out.lowered) += std::abs(rise) * ground.cell() * ground.cell();
    }
  return out;
}

}  // namespace navvy::heightfield::testing
