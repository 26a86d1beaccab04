// SPDX-License-Identifier: Apache-2.0
// The program step `wait`: waits for a given time.
#pragma once

#include "control/activity_step.h"

namespace navvy::control {

/// Waits for a given time while the last commands stay in effect.
struct Wait final : ActivityStep {
  /// Name of the step's element in scene files.
  static constexpr const char* kElement = "wait";
  /// One-sentence description of the step for the reference of scene elements.
  static constexpr const char* kText = "Waits.";
  /// Makes a step that waits for `duration_in` [s].
  explicit Wait(double duration_in = 1) : duration(duration_in) {}
  /// Time to wait [s].
  double duration;

  /// Lists the child elements of the step with their ranges and descriptions.
  void describe(scene::Fields& f) override {
    f("duration_s", duration, {0, 1e6}, "Time to wait.", scene::kNeeded);
  }
  /// Checks nothing: there are no rules beyond the range of the duration.
  void check(const scene::StepSource&) {}
  /// Returns the name of the step's element in scene files.
  const char* element() const override { return kElement; }
  /// Returns an activity with one phase, "wait", which issues no new commands.
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
};

}  // namespace navvy::control
