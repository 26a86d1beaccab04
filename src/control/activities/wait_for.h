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
  explicit WaitFor(std::string machine_in = "", int steps_in = 0, double longest_in = 3600)
      : machine(std::move(machine_in)), steps(steps_in), longest(longest_in) {}
  std::string machine;
  int steps;       ///< 0: all
  double longest;  ///< patience [s]

  /// Elements: <machine>, <steps>, <longest_s>.
  static WaitFor read(const scene::StepSource& source);
  const char* element() const override { return kElement; }
  std::optional<scene::Waiting> waits_for() const override {
    return scene::Waiting{machine, steps};
  }
  /// One phase: holds what was commanded.
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
};

}  // namespace navvy::control
