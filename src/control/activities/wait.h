// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "control/activity_step.h"

namespace navvy::control {

/// Holds the last commands for a while.
struct Wait final : ActivityStep {
  /// Name in scene files.
  static constexpr const char* kElement = "wait";
  explicit Wait(double duration_in = 1) : duration(duration_in) {}
  /// Duration [s].
  double duration;

  /// Reads <duration_s>.
  static Wait read(const scene::StepSource& source);
  const char* element() const override { return kElement; }
  /// Returns an activity with one phase, which holds the last commands.
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
};

}  // namespace navvy::control
