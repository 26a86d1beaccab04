// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "control/activity_step.h"

namespace navvy::control {

/// Holds the last commands for a while.
struct Wait final : ActivityStep {
  /// Name in scene files.
  static constexpr const char* kElement = "wait";
  /// Sentence for the reference of scene elements.
  static constexpr const char* kText = "Waits.";
  explicit Wait(double duration_in = 1) : duration(duration_in) {}
  /// Duration [s].
  double duration;

  void describe(scene::Fields& f) override {
    f("duration_s", duration, {0, 1e6}, "Time to wait.", scene::kNeeded);
  }
  void check(const scene::StepSource&) {}
  const char* element() const override { return kElement; }
  /// Returns an activity with one phase, which holds the last commands.
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
};

}  // namespace navvy::control
