// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "control/program_step.h"

namespace navvy::control {

/// Stay as it is for a while.
struct Wait final : ProgramStep {
  /// Name in scene files.
  static constexpr const char* kElement = "wait";
  explicit Wait(double duration_in = 1) : duration(duration_in) {}
  double duration;  ///< [s]

  /// Elements: <duration_s>.
  static Wait read(const scene::StepSource& source);
  const char* element() const override { return kElement; }
  /// One phase: holds what was commanded.
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
};

}  // namespace navvy::control
