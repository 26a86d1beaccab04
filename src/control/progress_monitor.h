// SPDX-License-Identifier: Apache-2.0
// Detects whether a driving machine makes progress, and what holds it when it does not.
#pragma once

#include <string>

#include "control/observation.h"
#include "control/outcome.h"
#include "control/pursuit.h"
#include "core/archive.h"
#include "scene/machine.h"

namespace navvy::control {

/// Compares the machine's pose with the pose at which it last made progress. Part of the state of
/// every step that drives.
class ProgressMonitor {
 public:
  /// Starts to monitor from this pose.
  void begin(const PlanePose& at);
  /// Checks one control step of driving at `speed` [m/s] with `left` [m] to the target. Returns
  /// kRunning while there is progress. Otherwise the machine has stood for the whole patience, 5 s
  /// or what a slower drive needs, and `reason` says what holds it.
  StepState look(const Observation& seen, const scene::Machine& machine, double speed, double left,
                 double dt, std::string& reason);

  void visit(Archive& a) {
    a("anchor", anchor_);
    a("stuck", stuck_);
    a("rolled", rolled_);
    a("push", push_);
  }

 private:
  // Since the machine last made progress: its pose then (x, y [m], yaw [rad]), the time since [s],
  // the distance its wheels have rolled since [m], and the integral of the tyres' force [N s].
  Vec3 anchor_ = Vec3::Zero();
  double stuck_ = 0, rolled_ = 0;
  Vec3 push_ = Vec3::Zero();
};

/// Time at rest with the brake on after which a machine counts as standing [s].
inline constexpr double kStandTime = 0.5;
/// Speed below which a machine counts as standing [m/s].
inline constexpr double kStandSpeed = 0.02;

}  // namespace navvy::control
