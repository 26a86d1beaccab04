// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

#include "control/program_step.h"

namespace navvy::control {

/// Wait until another machine of the world has done some or all steps of its program. What cannot
/// come any more, or not within `longest`, ends the program.
struct WaitFor final : ProgramStep {
  /// Name in scene files.
  static constexpr const char* kElement = "wait_for";
  static constexpr const char* kText =
      "Waits until another machine has done some or all steps of its program.";
  explicit WaitFor(std::string machine_in = "", int steps_in = 0, double longest_in = 3600)
      : machine(std::move(machine_in)), steps(steps_in), longest(longest_in) {}
  std::string machine;
  int steps;  ///< 0: all
  bool has_steps = false;
  double longest;  ///< patience [s]

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
  /// One phase: holds what was commanded.
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
};

}  // namespace navvy::control
