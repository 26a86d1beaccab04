// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "control/program_step.h"

namespace navvy::control {

/// Open the bucket where it is, then curl back.
struct Dump final : ProgramStep {
  /// Name in scene files.
  static constexpr const char* kElement = "dump";
  explicit Dump(double hold_in = 1.0) : hold(hold_in) {}
  double hold;  ///< between opened and closing [s]

  /// Elements: <hold_s>.
  static Dump read(const scene::StepSource& source);
  const char* element() const override { return kElement; }
  bool needs_arm() const override { return true; }
  /// One phase: two moves of the bucket.
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
};

}  // namespace navvy::control
