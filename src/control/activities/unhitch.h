// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

#include "control/program_step.h"

namespace navvy::control {

/// Let go of what hangs on the machine, or of what it hangs on.
struct Unhitch final : ProgramStep {
  /// Name in scene files.
  static constexpr const char* kElement = "unhitch";
  explicit Unhitch(std::string hitch_in = "") : hitch(std::move(hitch_in)) {}
  std::string hitch;  ///< of the scene, by its name

  /// Elements: <hitch>.
  static Unhitch read(const scene::StepSource& source);
  const char* element() const override { return kElement; }
  std::optional<std::string> opens() const override { return hitch; }
  /// One phase of one control step.
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
};

}  // namespace navvy::control
