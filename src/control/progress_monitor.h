// SPDX-License-Identifier: Apache-2.0
// Detects whether a driving machine makes progress, and the cause if it does not.
#pragma once

#include <string>

#include "control/observation.h"
#include "control/outcome.h"
#include "control/pursuit.h"
#include "core/archive.h"
#include "scene/machine.h"

namespace navvy::control {

/// Compares the pose of a driving machine with its pose when it last made progress. The monitor is
/// part of the state of every step that drives.
class ProgressMonitor {
 public:
  /// Starts monitoring a machine at the pose `at`.
  void begin(const PlanePose& at);
  /// Updates the monitor after one control step of `dt` [s]. `speed` is the commanded speed [m/s],
  /// `left` the distance to the target [m], for messages, and `remaining` a length that decreases
  /// while the machine advances along its path [m]. Returns kRunning while the machine makes
  /// progress. If it has not moved for 5 s, or longer for a slow drive, returns kBlocked (an
  /// obstacle holds it) or kStalled (its wheels spin or do not turn) and stores an explanation in
  /// `reason`. A machine that moves without advancing for 20 s, or longer for a slow drive, is
  /// stalled too.
  StepState look(const Observation& seen, const scene::Machine& machine, double speed, double left,
                 double remaining, double dt, std::string& reason);

  /// Saves or loads the state of the monitor.
  void visit(Archive& a) {
    a("anchor", anchor_);
    a("stuck", stuck_);
    a("rolled", rolled_);
    a("push", push_);
    a("least", least_);
    a("idle", idle_);
  }

 private:
  /// Sets the pose from which motion is measured.
  void anchor(const PlanePose& at);

  // Pose of the machine when it last made progress: x, y [m] and yaw [rad].
  Vec3 anchor_ = Vec3::Zero();
  // Since then: elapsed time [s], and distance that the fastest driven wheel has rolled [m].
  double stuck_ = 0, rolled_ = 0;
  // Time integral of the force of the ground on the wheels in W since then [N s].
  Vec3 push_ = Vec3::Zero();
  // Least remaining length so far [m], below zero before the first one; and time since the machine
  // advanced last [s].
  double least_ = -1, idle_ = 0;
};

/// Minimum time at rest, with the brake on, after which a machine counts as standing [s].
inline constexpr double kStandTime = 0.5;
/// Speed below which a machine counts as being at rest [m/s].
inline constexpr double kStandSpeed = 0.02;

}  // namespace navvy::control
