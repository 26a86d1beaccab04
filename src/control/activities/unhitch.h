// SPDX-License-Identifier: Apache-2.0
// The program step `unhitch`: opens a hitch.
#pragma once

#include <string>
#include <utility>

#include "control/activity_step.h"

namespace navvy::control {

/// Opens a hitch of this machine. The machine may be the towing or the towed one.
struct Unhitch final : ActivityStep {
  /// Name of the step's element in scene files.
  static constexpr const char* kElement = "unhitch";
  /// One-sentence description of the step for the reference of scene elements.
  static constexpr const char* kText = "Opens a hitch of the machine.";
  /// Makes a step that opens the hitch named `hitch_in`.
  explicit Unhitch(std::string hitch_in = "") : hitch(std::move(hitch_in)) {}
  /// Name of the hitch in the scene.
  std::string hitch;

  /// Lists the child elements of the step with their descriptions.
  void describe(scene::Fields& f) override {
    f("hitch", hitch, scene::Refers::kHitch, "A navvy:hitch whose parent or child the machine is.",
      scene::kNeeded);
  }
  /// Checks nothing: the scene reader checks the hitch when it has read all machines.
  void check(const scene::StepSource&) {}
  /// Returns the name of the step's element in scene files.
  const char* element() const override { return kElement; }
  /// Returns the name of the hitch that the step opens.
  std::optional<std::string> opens() const override { return hitch; }
  /// Returns an activity with one phase, which lasts one control step.
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
};

}  // namespace navvy::control
