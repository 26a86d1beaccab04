// SPDX-License-Identifier: Apache-2.0
// The program step `if_short`: where a program goes on when a step before it has fallen short.
#pragma once

#include <memory>
#include <vector>

#include "control/activity_step.h"

namespace navvy::control {

/// Lets a program go on after a step that did not reach its aim, instead of ending it. When a step
/// falls short, the steps between it and the next `if_short` are left out; the `steps` after the
/// `if_short` then run. If nothing fell short, they are left out.
///
/// A machine that has tipped over, is buried or off the site goes nowhere: its program ends.
struct IfShort final : ActivityStep {
  /// Name of the step's element in scene files.
  static constexpr const char* kElement = "if_short";
  /// One-sentence description of the step for the reference of scene elements.
  static constexpr const char* kText =
      "Lets the program go on after a step that fell short, and runs some steps only then.";
  /// Number of steps after this one that run only if a step fell short.
  int steps = 0;

  /// Lists the child elements of the step with their ranges and descriptions.
  void describe(scene::Fields& f) override {
    f("steps", steps, {0, 2000}, "Number of steps after this one that run only then.");
  }
  /// Checks nothing: `check_reach` knows the program.
  void check(const scene::StepSource&) {}
  /// Returns the name of the step's element in scene files.
  const char* element() const override { return kElement; }
  /// Returns true: the program goes on here.
  bool catches() const override { return true; }
  /// Returns an activity with one phase, "if_short", which takes one control step.
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
  /// Reports an error if the program has no step before this one, or fewer after it.
  void check_reach(ReachCheck& check) const override;
};

}  // namespace navvy::control
