// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "control/program_step.h"

namespace navvy::control {

/// Tip the bed to an angle of its joint, at the pace its cylinder allows, and keep it there for a
/// while. It stays until the next tip, also while the machine drives.
struct Tip final : ProgramStep {
  /// Name in scene files.
  static constexpr const char* kElement = "tip";
  explicit Tip(double angle_in = 0, double hold_in = 0) : angle(angle_in), hold(hold_in) {}
  double angle;  ///< [rad]
  double hold;   ///< after it has arrived [s]

  /// Elements: <angle_deg>, <hold_s>; the angle must lie within the limits of the bed's joint.
  static Tip read(const scene::StepSource& source);
  const char* element() const override { return kElement; }
  void check_machine(const scene::Machine& machine) const override;
  /// One phase: commands the bed's joint alone.
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
};

}  // namespace navvy::control
