// SPDX-License-Identifier: Apache-2.0
// Feedback of the measured yaw rate: corrects the steering of a machine that does not follow the
// arc of its wheels.
#pragma once

#include "control/pursuit.h"
#include "core/archive.h"
#include "scene/drive.h"

namespace navvy::control {

/// Integrates the difference between the curvature that a machine should drive and the curvature
/// that it drives, and adds the integral to its steering.
///
/// Wheels that slip sideways, as those of a skid-steered machine always do, turn a machine less
/// than they would if they rolled. The integral grows with the driven distance, so a steered
/// machine that stands is not corrected. A machine that turns by the speed difference of its sides
/// also slows down while it turns less than it should, so that its motors have force left for the
/// turn. Curvatures are positive to the left and refer to driving forwards.
class CurvatureFeedback {
 public:
  /// Steering of the equivalent bicycle.
  struct Steering {
    /// Angle [rad], positive to the left. It refers to the speed without `ease`.
    double angle = 0;
    /// Share of the wanted speed at which the machine is to drive [-], in 0.3..1.
    double ease = 1;
  };

  /// Starts the feedback with a zero integral for a machine at the pose `at` with wheels straight.
  void begin(const PlanePose& at);
  /// Advances by one control step of `dt` [s] and returns the steering to command. `at` is the
  /// machine's pose, `angle` the wanted angle of the bicycle [rad], `wanted` the wanted speed, and
  /// `speed` the speed of the base link along its x axis [m/s], both negative backwards.
  Steering correct(const scene::AckermannDrive& bicycle, const PlanePose& at, double angle,
                   double wanted, double speed, double dt);

  /// Saves or loads the state of the feedback.
  void visit(Archive& a) {
    a("yaw", yaw_);
    a("rate", rate_);
    a("rolled", rolled_);
    a("angle", angle_);
    a("integral", integral_);
    a("ease", ease_);
  }

 private:
  // Yaw in the last control step [rad]; low-pass filtered yaw rate [rad/s] and speed [m/s].
  double yaw_ = 0, rate_ = 0, rolled_ = 0;
  // Angle of the equivalent bicycle that its steering has reached, without the integral [rad].
  double angle_ = 0;
  // Integral of the missing curvature [1/m].
  double integral_ = 0;
  // Share of the wanted speed [-].
  double ease_ = 1;
};

/// Returns the speed of the base link along its x axis [m/s] from its velocity in W.
double forward_speed(const PlanePose& at, const Vec3& v_WB);

}  // namespace navvy::control
