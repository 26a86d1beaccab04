// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "control/activity_step.h"

namespace navvy::control {

/// Turns the upper structure to this angle of the swing joint with the bucket held.
struct Swing final : ActivityStep {
  /// Name in scene files.
  static constexpr const char* kElement = "swing";
  /// Sentence for the reference of scene elements.
  static constexpr const char* kText = "Turns the upper structure, with the bucket held.";
  explicit Swing(double angle_in = 0) : angle(angle_in) {}
  /// Target angle [rad].
  double angle;

  void describe(scene::Fields& f) override {
    f("angle_deg", angle, {-3600, 3600}, "Position of the swing joint.", scene::kNeeded);
  }
  /// Checks that the machine has a swing joint.
  void check(const scene::StepSource& source) const;
  const char* element() const override { return kElement; }
  bool needs_arm() const override { return true; }
  /// Returns an activity with one phase: a move of one axis.
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
  void check_reach(ReachCheck& check) const override;
};

}  // namespace navvy::control
