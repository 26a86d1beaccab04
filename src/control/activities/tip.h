// SPDX-License-Identifier: Apache-2.0
// The program step `tip`: tips the bed of a truck or trailer.
#pragma once

#include "control/activity_step.h"

namespace navvy::control {

/// Tips the bed to a given angle, as fast as its cylinder allows, and holds it there for a given
/// time. After the step, the bed keeps its angle until the next tip step, even while the machine
/// drives. The step fails if the bed does not reach its angle in time.
struct Tip final : ActivityStep {
  /// Name of the step's element in scene files.
  static constexpr const char* kElement = "tip";
  /// One-sentence description of the step for the reference of scene elements.
  static constexpr const char* kText =
      "Tips the bed at the pace of its cylinder; it stays there until the next tip.";
  /// Makes a step with the target angle `angle_in` [rad] and the holding time `hold_in` [s].
  explicit Tip(double angle_in = 0, double hold_in = 0) : angle(angle_in), hold(hold_in) {}
  /// Target angle of the bed's joint [rad].
  double angle;
  /// Time for which the step continues after the bed has arrived [s].
  double hold;

  /// Lists the child elements of the step with their ranges and descriptions.
  void describe(scene::Fields& f) override {
    f("angle_deg", angle, {-360, 360}, "Position of the bed's joint.", scene::kNeeded);
    f("hold_s", hold, {0, 600}, "Time to wait after the bed has arrived.");
  }
  /// Reports an error if the machine has no bed, or the angle is outside the limits of the bed's
  /// joint.
  void check(const scene::StepSource& source) const;
  /// Returns the name of the step's element in scene files.
  const char* element() const override { return kElement; }
  /// Checks that the machine's first bed has a joint of its own. @throws InputError otherwise.
  void check_machine(const scene::Machine& machine) const override;
  /// Returns an activity with one phase, "tip". It commands only the joint of the bed.
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
};

}  // namespace navvy::control
