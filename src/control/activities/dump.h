// SPDX-License-Identifier: Apache-2.0
// The program step `dump`: opens the bucket and closes it again.
#pragma once

#include "control/activity_step.h"

namespace navvy::control {

/// Opens the bucket at its current position, waits, and curls it back.
struct Dump final : ActivityStep {
  /// Name of the step's element in scene files.
  static constexpr const char* kElement = "dump";
  /// One-sentence description of the step for the reference of scene elements.
  static constexpr const char* kText = "Opens the bucket where it is, then closes it.";
  /// Makes a step that waits `hold_in` [s] between opening and closing the bucket.
  explicit Dump(double hold_in = 1.0) : hold(hold_in) {}
  /// Time between opening and closing the bucket [s].
  double hold;

  /// Lists the child elements of the step with their ranges and descriptions.
  void describe(scene::Fields& f) override {
    f("hold_s", hold, {0, 600}, "Time between opening and closing.");
  }
  /// Reports an error if the machine has no bucket joint.
  void check(const scene::StepSource& source) const;
  /// Returns the name of the step's element in scene files.
  const char* element() const override { return kElement; }
  /// Returns true: the bucket is part of the arm.
  bool needs_arm() const override { return true; }
  /// Returns an activity with one phase, "dump", which makes two moves of the bucket.
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
};

}  // namespace navvy::control
