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
  explicit WaitFor(std::string machine_in = "", int steps_in = 0, double longest_in = 3600)
      : machine(std::move(machine_in)), steps(steps_in), longest(longest_in) {}
  std::string machine;
  /// Number of steps to wait for; 0: all.
  int steps;
  /// Time limit [s].
  double longest;

  /// Reads <machine>, <steps>, <longest_s>.
  static WaitFor read(const scene::StepSource& source);
  const char* element() const override { return kElement; }
  std::optional<scene::Waiting> waits_for() const override {
    return scene::Waiting{machine, steps};
  }
  /// Returns an activity with one phase, which holds the last commands.
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
};

}  // namespace navvy::control
