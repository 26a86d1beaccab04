// SPDX-License-Identifier: Apache-2.0
// The program step `wait_load`: waits until the machine's bed has been loaded.
#pragma once

#include "control/activity_step.h"

namespace navvy::control {

/// Waits until the machine's bed holds a given mass, and a little longer, until the bucket is out
/// of the way. If no more soil comes for a given time, the step is done with what is in the bed,
/// and fails if that is nothing.
struct WaitLoad final : ActivityStep {
  /// Name of the step's element in scene files.
  static constexpr const char* kElement = "wait_load";
  /// One-sentence description of the step for the reference of scene elements.
  static constexpr const char* kText = "Waits until the machine's bed has been loaded.";
  /// Makes a step that waits for a mass of `load_in` [kg], for `longest_in` [s] at most without
  /// more soil.
  explicit WaitLoad(double load_in = 1000, double longest_in = 600)
      : load(load_in), longest(longest_in) {}
  /// Mass of soil in the bed at which it is loaded [kg].
  double load;
  /// Longest time without more soil [s].
  double longest;
  /// Time from then until the step is done [s].
  double clear = 6;

  /// Lists the child elements of the step with their ranges and descriptions.
  void describe(scene::Fields& f) override {
    f("load_kg", load, {1, 1e6}, "Mass of soil in the machine's own bed at which it is loaded.",
      scene::kNeeded);
    f("longest_s", longest, {0, 1e6},
      "Longest time without more soil: then the step is done with what is in the bed, and fails "
      "if it is empty.");
    f("clear_s", clear, {0, 600}, "Time to wait when it is loaded, until the bucket is away.");
  }
  /// Reports an error if the machine has no bed.
  void check(const scene::StepSource& source) const;
  /// Returns the name of the step's element in scene files.
  const char* element() const override { return kElement; }
  /// Checks that the machine has a bed. @throws InputError otherwise.
  void check_machine(const scene::Machine& machine) const override;
  /// Returns an activity with one phase, "wait_load", which issues no new commands.
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
};

}  // namespace navvy::control
