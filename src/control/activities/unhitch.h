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
  /// Sentence for the reference of scene elements.
  static constexpr const char* kText = "Opens a hitch of the machine.";
  explicit Unhitch(std::string hitch_in = "") : hitch(std::move(hitch_in)) {}
  /// Name of the hitch in the scene.
  std::string hitch;

  void describe(scene::Fields& f) override {
    f("hitch", hitch, scene::Refers::kHitch, "A navvy:hitch whose parent or child the machine is.",
      scene::kNeeded);
  }
  /// The hitch is checked when all machines have been read.
  void check(const scene::StepSource&) {}
  const char* element() const override { return kElement; }
  std::optional<std::string> opens() const override { return hitch; }
  /// Returns an activity with one phase of one control step.
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
};

}  // namespace navvy::control
