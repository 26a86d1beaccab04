// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

#include "control/activity_step.h"

namespace navvy::control {

/// Opens a hitch of this machine, as the towing or the towed one.
struct Unhitch final : ActivityStep {
  /// Name in scene files.
  static constexpr const char* kElement = "unhitch";
  explicit Unhitch(std::string hitch_in = "") : hitch(std::move(hitch_in)) {}
  /// Name of the hitch in the scene.
  std::string hitch;

  /// Reads <hitch>.
  static Unhitch read(const scene::StepSource& source);
  const char* element() const override { return kElement; }
  std::optional<std::string> opens() const override { return hitch; }
  /// Returns an activity with one phase of one control step.
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
};

}  // namespace navvy::control
