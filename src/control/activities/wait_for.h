// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

#include "control/activity_step.h"

namespace navvy::control {

/// Waits until another machine of the world has completed some or all steps of its program. The
/// program ends when that cannot happen any more, or does not happen within `longest`.
struct WaitFor final : ActivityStep {
  /// Name in scene files.
  static constexpr const char* kElement = "wait_for";
  /// Sentence for the reference of scene elements.
  static constexpr const char* kText =
      "Waits until another machine has done some or all steps of its program.";
  explicit WaitFor(std::string machine_in = "", int steps_in = 0, double longest_in = 3600)
      : machine(std::move(machine_in)), steps(steps_in), longest(longest_in) {}
  std::string machine;
  /// Number of steps to wait for; 0: all.
  int steps;
  /// Time limit [s].
  double longest;
  /// True if `steps` was given.
  bool has_steps = false;

  void describe(scene::Fields& f) override {
    f("machine", machine, "Machine to wait for.", scene::kNeeded);
    f("steps", steps, {1, 1e6}, "Number of its steps; by default all.", scene::given(has_steps));
    f("longest_s", longest, {0, 1e6}, "Time after which the program ends instead.");
  }
  /// The machine and its number of steps are checked when all programs have been read.
  void check(const scene::StepSource&) {}
  const char* element() const override { return kElement; }
  std::optional<scene::Waiting> waits_for() const override {
    return scene::Waiting{machine, steps};
  }
  /// Returns an activity with one phase, which holds the last commands.
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
};

}  // namespace navvy::control
