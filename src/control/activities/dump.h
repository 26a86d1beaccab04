// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "control/activity_step.h"

namespace navvy::control {

/// Opens the bucket where it is, then curls it back.
struct Dump final : ActivityStep {
  /// Name in scene files.
  static constexpr const char* kElement = "dump";
  /// Sentence for the reference of scene elements.
  static constexpr const char* kText = "Opens the bucket where it is, then closes it.";
  explicit Dump(double hold_in = 1.0) : hold(hold_in) {}
  /// Time between opening and closing [s].
  double hold;

  void describe(scene::Fields& f) override {
    f("hold_s", hold, {0, 600}, "Time between opening and closing.");
  }
  /// Checks that the machine has a bucket joint.
  void check(const scene::StepSource& source) const;
  const char* element() const override { return kElement; }
  bool needs_arm() const override { return true; }
  /// Returns an activity with one phase: two moves of the bucket.
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
};

}  // namespace navvy::control
