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
  static constexpr const char* kText = "Opens a hitch of the machine.";
  explicit Unhitch(std::string hitch_in = "") : hitch(std::move(hitch_in)) {}
  std::string hitch;  ///< of the scene, by its name

  void describe(scene::Fields& f) override {
    f("hitch", hitch, scene::Refers::kHitch, "A navvy:hitch whose parent or child the machine is.",
      scene::kNeeded);
  }
  /// The hitch is checked when all machines have been read.
  void check(const scene::StepSource&) {}
  const char* element() const override { return kElement; }
  std::optional<std::string> opens() const override { return hitch; }
  /// One phase of one control step.
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
};

}  // namespace navvy::control
