// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "control/activity_step.h"

namespace navvy::control {

/// Moves joints along open-loop positions over time, linear between knots; times count from the
/// start of this step.
struct Trajectory final : ActivityStep {
  /// Name in scene files.
  static constexpr const char* kElement = "trajectory";
  std::vector<std::string> joints;
  /// Times of the knots [s], increasing.
  std::vector<double> times;
  /// Positions as [knot][joint], [rad] or [m].
  std::vector<std::vector<double>> positions;

  /// Reads <times_s> and a <joint name="..."> with <positions_deg> or <positions_m> for every
  /// joint.
  static Trajectory read(const scene::StepSource& source);
  const char* element() const override { return kElement; }
  /// Checks the trajectory against the machine. @throws InputError also for anything that the
  /// reader would have refused.
  void check_machine(const scene::Machine& machine) const override;
  /// Returns an activity with one phase, which commands only its joints.
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
};

}  // namespace navvy::control
