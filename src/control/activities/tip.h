// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "control/activity_step.h"

namespace navvy::control {

/// Tips the bed to an angle of its joint at the pace its cylinder allows, and holds it there for a
/// while. The bed stays there until the next tip, also while the machine drives.
struct Tip final : ActivityStep {
  /// Name in scene files.
  static constexpr const char* kElement = "tip";
  explicit Tip(double angle_in = 0, double hold_in = 0) : angle(angle_in), hold(hold_in) {}
  /// Target angle of the bed's joint [rad].
  double angle;
  /// Time to hold after arrival [s].
  double hold;

  /// Reads <angle_deg>, <hold_s>; the angle must be within the limits of the bed's joint.
  static Tip read(const scene::StepSource& source);
  const char* element() const override { return kElement; }
  void check_machine(const scene::Machine& machine) const override;
  /// Returns an activity with one phase, which commands only the bed's joint.
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
};

}  // namespace navvy::control
