// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "control/activity_step.h"

namespace navvy::control {

/// Tips the bed to an angle of its joint at the pace its cylinder allows, and holds it there for a
/// while. The bed stays there until the next tip, also while the machine drives.
struct Tip final : ActivityStep {
  /// Name in scene files.
  static constexpr const char* kElement = "tip";
  /// Sentence for the reference of scene elements.
  static constexpr const char* kText =
      "Tips the bed at the pace of its cylinder; it stays there until the next tip.";
  explicit Tip(double angle_in = 0, double hold_in = 0) : angle(angle_in), hold(hold_in) {}
  /// Target angle of the bed's joint [rad].
  double angle;
  /// Time to hold after arrival [s].
  double hold;

  void describe(scene::Fields& f) override {
    f("angle_deg", angle, {-360, 360}, "Position of the bed's joint.", scene::kNeeded);
    f("hold_s", hold, {0, 600}, "Time to wait after the bed has arrived.");
  }
  /// Checks that the machine has a bed and the angle is within the limits of its joint.
  void check(const scene::StepSource& source) const;
  const char* element() const override { return kElement; }
  void check_machine(const scene::Machine& machine) const override;
  /// Returns an activity with one phase, which commands only the bed's joint.
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
};

}  // namespace navvy::control
