// SPDX-License-Identifier: Apache-2.0
// The program step `swing`: turns the upper structure of an excavator.
#pragma once

#include "control/activity_step.h"

namespace navvy::control {

/// Turns the upper structure of an excavator to a given angle of the swing joint. Boom, stick and
/// bucket keep their angles. The step fails if an obstacle stops the swing.
struct Swing final : ActivityStep {
  /// Name of the step's element in scene files.
  static constexpr const char* kElement = "swing";
  /// One-sentence description of the step for the reference of scene elements.
  static constexpr const char* kText = "Turns the upper structure, with the bucket held.";
  /// Makes a step with the target angle `angle_in` [rad].
  explicit Swing(double angle_in = 0) : angle(angle_in) {}
  /// Target angle of the swing joint [rad].
  double angle;
  /// True: the arm also moves to its angles at the start of the scene, over the machine, so that
  /// weight is on the driven axle. Not an element of scenes: a job sets it before it drives.
  bool tucks = false;

  /// Lists the child elements of the step with their ranges and descriptions.
  void describe(scene::Fields& f) override {
    f("angle_deg", angle, {-3600, 3600}, "Position of the swing joint.", scene::kNeeded);
  }
  /// Reports an error if the machine has no swing joint.
  void check(const scene::StepSource& source) const;
  /// Returns the name of the step's element in scene files.
  const char* element() const override { return kElement; }
  /// Returns true: the arm is held while the upper structure turns.
  bool needs_arm() const override { return true; }
  /// Returns an activity with one phase, "swing", which moves only the swing joint.
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
  /// Reports an error if the target angle is outside the limits of the swing joint.
  void check_reach(ReachCheck& check) const override;
};

}  // namespace navvy::control
