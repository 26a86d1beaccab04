// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "control/activity_step.h"

namespace navvy::control {

/// Turns the upper structure to this angle of the swing joint with the bucket held.
struct Swing final : ActivityStep {
  /// Name in scene files.
  static constexpr const char* kElement = "swing";
  explicit Swing(double angle_in = 0) : angle(angle_in) {}
  /// Target angle [rad].
  double angle;

  /// Reads <angle_deg>.
  static Swing read(const scene::StepSource& source);
  const char* element() const override { return kElement; }
  bool needs_arm() const override { return true; }
  /// Returns an activity with one phase: a move of one axis.
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
  void check_reach(ReachCheck& check) const override;
};

}  // namespace navvy::control
