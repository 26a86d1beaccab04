// SPDX-License-Identifier: Apache-2.0
// Length of a transfer, over which weights, masses, lists and sides are held
// [docs/soil.md, transfer].
#pragma once

#include <cmath>

#include "core/archive.h"
#include "soil/scheme_constants.h"

namespace navvy::soil {

/// The current transfer. Solver and double twin share its rules.
///
/// A transfer ends when its length is reached, rounded to whole steps, or when the fastest particle
/// or tool could go farther than `most_motion` in one more step. Bounds of displacements are sums
/// of speed x time, so they never underestimate.
struct TransferInterval {
  /// A step was done since the last transfer ended.
  bool open = false;
  /// Time since its start [s].
  double time = 0;
  /// Upper bound of a particle's displacement since then [cells].
  double motion = 0;
  /// Upper bound of a tool's displacement since then [cells].
  double travel = 0;
  /// Largest velocity component of any particle after the last step [m/s].
  double speed = 0;

  /// Returns true if one more step of dt [s] fits. `length` in s, `tool_speed` in m/s, `gravity` in
  /// m/s2, `most_motion`: longest displacement of a particle or a tool in a transfer [cells].
  bool holds(double dt, double length, double cell, double tool_speed, double gravity,
             double most_motion = kScheme.max_transfer_motion) const {
    // Rounded to whole steps: half a step more would be closer to the length than none.
    if (!open || time + 0.5 * dt >= length) return false;
    // Free fall is the smallest change of speed to expect.
    if (motion + dt * (speed + dt * gravity) / cell > most_motion) return false;
    return travel + dt * tool_speed / cell <= most_motion;
  }
  /// Counts a step of dt [s] after which the fastest particle moves at `fastest` [m/s].
  void count_step(double dt, double cell, double fastest, double tool_speed) {
    open = true;
    time += dt;
    motion += dt * fastest / cell;
    travel += dt * tool_speed / cell;
    speed = fastest;
  }

  /// Visits all of it: held steps depend on it.
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
