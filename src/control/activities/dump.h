// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "control/activity_step.h"

namespace navvy::control {

/// Opens the bucket where it is, then curls it back.
struct Dump final : ActivityStep {
  /// Name in scene files.
  static constexpr const char* kElement = "dump";
  explicit Dump(double hold_in = 1.0) : hold(hold_in) {}
  /// Time between opening and closing [s].
  double hold;

  /// Reads <hold_s>.
  static Dump read(const scene::StepSource& source);
  const char* element() const override { return kElement; }
  bool needs_arm() const override { return true; }
  /// Returns an activity with one phase: two moves of the bucket.
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
};

}  // namespace navvy::control
