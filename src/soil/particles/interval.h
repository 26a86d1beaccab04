// SPDX-License-Identifier: Apache-2.0
// How long a transfer lasts: its weights, masses, lists and sides are held over several steps
// [docs/soil.md, transfer].
#pragma once

#include <cmath>

#include "core/archive.h"

namespace navvy::soil {

/// Cells that the fastest particle, or a tool, may go while a transfer holds; weights and near
/// nodes are those of its start. tuned: `navvy lab throw`. Without it eight steps a transfer spoil
/// thrown soil (volume 0.76 of its state).
inline constexpr double kMostHeld = 0.2;
/// Length of a transfer in units of cell / sound speed: four steps at a Courant number of 0.5. A
/// transfer damps short waves; at a fixed length the damping is one per time, whatever the step.
inline constexpr double kTransferLength = 2;

/// The transfer that is under way. Solver and double twin ask the same questions of it.
struct TransferInterval {
  bool open = false;  ///< a step was done since the last transfer ended
  double time = 0;    ///< since its start [s]
  double motion = 0;  ///< most that a particle can have gone since then [cells]
  double travel = 0;  ///< the same of a tool [cells]
  double speed = 0;   ///< fastest component of a particle's velocity after the last step [m/s]

  /// Whether one more step of dt [s] may be held; `length` in s, `tool_speed` in m/s, `gravity` in
  /// m/s2.
  bool holds(double dt, double length, double cell, double tool_speed, double gravity) const {
    // Rounded to whole steps: half a step more would be nearer to the length than none.
    if (!open || time + 0.5 * dt >= length) return false;
    // Free fall is the least change of speed that has to be expected.
    if (motion + dt * (speed + dt * gravity) / cell > kMostHeld) return false;
    return travel + dt * tool_speed / cell <= kMostHeld;
  }
  /// Books a step of dt [s] after which the fastest particle has this speed [m/s].
  void book(double dt, double cell, double fastest, double tool_speed) {
    open = true;
    time += dt;
    motion += dt * fastest / cell;
    travel += dt * tool_speed / cell;
    speed = fastest;
  }

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
