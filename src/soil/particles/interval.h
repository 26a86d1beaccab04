// SPDX-License-Identifier: Apache-2.0
// Duration of a transfer, during which particle weights, node masses, block lists and particle
// sides stay fixed [docs/soil.md, transfer].
#pragma once

#include <cmath>

#include "core/archive.h"
#include "soil/scheme_constants.h"

namespace navvy::soil {

/// Time and displacements since the current transfer began. Solver and double-precision twin share
/// its rules.
///
/// A transfer ends when its length, rounded to whole steps, is reached, or when the fastest
/// particle or tool could move farther than `most_motion` in one more step. Displacements are
/// bounded by sums of speed x time, so they are never underestimated.
struct TransferInterval {
  /// True while a transfer is in progress, from its first step on.
  bool open = false;
  /// Time since the transfer began [s].
  double time = 0;
  /// Upper bound of the displacement of any particle since the transfer began [cells].
  double motion = 0;
  /// Upper bound of the displacement of any tool since the transfer began [cells].
  double travel = 0;
  /// Largest velocity component of any particle after the last step [m/s].
  double speed = 0;

  /// Returns true if a transfer is in progress and one more step of dt [s] fits into it. `length`:
  /// intended duration [s]; `cell`: edge of a cell [m]; `tool_speed`: speed of the fastest tool
  /// [m/s]; `gravity`: magnitude [m/s2]; `most_motion`: longest displacement of a particle or tool
  /// during a transfer [cells].
  bool holds(double dt, double length, double cell, double tool_speed, double gravity,
             double most_motion = kScheme.max_transfer_motion) const {
    // Rounded to whole steps: half a step more would be closer to the length than none.
    if (!open || time + 0.5 * dt >= length) return false;
    // Free fall is the smallest change of speed to expect.
    if (motion + dt * (speed + dt * gravity) / cell > most_motion) return false;
    return travel + dt * tool_speed / cell <= most_motion;
  }
  /// Adds a step of dt [s], after it has run. `fastest`: largest velocity component of any particle
  /// after the step [m/s]; `tool_speed`: speed of the fastest tool [m/s].
  void count_step(double dt, double cell, double fastest, double tool_speed) {
    open = true;
    time += dt;
    motion += dt * fastest / cell;
    travel += dt * tool_speed / cell;
    speed = fastest;
  }

  /// Visits all members: they decide when the transfer ends.
  void visit(Archive& a) {
    a("open", open);
    a("time", time);
    a("motion", motion);
    a("travel", travel);
    a("speed", speed);
    for (const double value : {time, motion, travel, speed})
      a.require(std::isfinite(value) && value >= 0, "interval", "must be finite and not negative");
  }
};

}  // namespace navvy::soil
