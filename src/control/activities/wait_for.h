// SPDX-License-Identifier: Apache-2.0
// The program step `wait_for`: waits for the program of another machine.
#pragma once

#include <string>
#include <utility>

#include "control/activity_step.h"

namespace navvy::control {

/// Waits until another machine of the world has completed a given number of steps of its program.
/// The step fails if that machine's program has failed before, or if the time limit `longest` is
/// reached.
struct WaitFor final : ActivityStep {
  /// Name of the step's element in scene files.
  static constexpr const char* kElement = "wait_for";
  /// One-sentence description of the step for the reference of scene elements.
  static constexpr const char* kText =
      "Waits until another machine has done some or all steps of its program.";
  /// Makes a step that waits for the machine named `machine_in` to complete `steps_in` steps (0:
  /// all), for `longest_in` [s] at most.
  explicit WaitFor(std::string machine_in = "", int steps_in = 0, double longest_in = 3600)
      : machine(std::move(machine_in)), steps(steps_in), longest(longest_in) {}
  /// Name of the machine to wait for.
  std::string machine;
  /// Number of steps that the other machine must have completed; 0 means all steps of its program.
  int steps;
  /// Time limit [s]. When it is reached, the step fails.
  double longest;
  /// True if the scene file gives `steps`.
  bool has_steps = false;

  /// Lists the child elements of the step with their ranges and descriptions.
  void describe(scene::Fields& f) override {
    f("machine", machine, "Machine to wait for.", scene::kNeeded);
    f("steps", steps, {1, 1e6}, "Number of its steps; by default all.", scene::given(has_steps));
    f("longest_s", longest, {0, 1e6}, "Time after which the program ends instead.");
  }
  /// Checks nothing: the scene reader checks machine and number of steps when it has read all
  /// programs.
  void check(const scene::StepSource&) {}
  /// Returns the name of the step's element in scene files.
  const char* element() const override { return kElement; }
  /// Returns the machine and the number of steps that this step waits for.
  std::optional<scene::Waiting> waits_for() const override {
    return scene::Waiting{machine, steps};
  }
  /// Returns an activity with one phase, "wait_for", which issues no new commands.
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
};

}  // namespace navvy::control
