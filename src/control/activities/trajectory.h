// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "control/program_step.h"

namespace navvy::control {

/// Open-loop joint positions over time, linear between knots; times count from the start of this
/// step.
struct Trajectory final : ProgramStep {
  /// Name in scene files.
  static constexpr const char* kElement = "trajectory";
  std::vector<std::string> joints;
  std::vector<double> times;                   ///< [s], increasing
  std::vector<std::vector<double>> positions;  ///< [knot][joint], [rad] or [m]

  /// Elements: <times_s> and a <joint name="..."> with <positions_deg> or <positions_m> for every
  /// joint.
  static Trajectory read(const scene::StepSource& source);
  const char* element() const override { return kElement; }
  /// @throws InputError for anything that the reader would have refused, too.
  void check_machine(const scene::Machine& machine) const override;
  /// One phase: commands its joints alone.
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
};

}  // namespace navvy::control
