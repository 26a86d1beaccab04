// SPDX-License-Identifier: Apache-2.0
// Whether a machine that drives gets on, and what holds it when it does not.
#pragma once

#include <string>

#include "control/observation.h"
#include "control/outcome.h"
#include "control/pursuit.h"
#include "core/archive.h"
#include "scene/machine.h"

namespace navvy::control {

/// Part of the memory of whatever drives. Looks where the machine was when it last got on.
class ProgressMonitor {
 public:
  /// From here on.
  void begin(const PlanePose& at);
  /// One control step of driving at `speed` [m/s] with `left` [m] to the target. Not kRunning: the
  /// machine has stood for its whole patience, 5 s or what a slower drive needs, and `reason` says
  /// so and what holds it.
  StepState look(const Observation& seen, const scene::Machine& machine, double speed, double left,
                 double dt, std::string& reason);

  void visit(Archive& a) {
    a("anchor", anchor_);
    a("stuck", stuck_);
    a("rolled", rolled_);
    a("push", push_);
  }

 private:
  // Since the machine last got on: where that was, how long ago [s], how far its wheels have rolled
  // [m], and the sum of the tyres' force over time [N s].
  Vec3 anchor_ = Vec3::Zero();  // x, y [m], yaw [rad]
  double stuck_ = 0, rolled_ = 0;
  Vec3 push_ = Vec3::Zero();
};

inline constexpr double kStandTime = 0.5;    ///< [s] at rest with the brake on: it stands
inline constexpr double kStandSpeed = 0.02;  ///< [m/s]

}  // namespace navvy::control
