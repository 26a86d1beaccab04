// SPDX-License-Identifier: Apache-2.0
// The program step `trajectory`: moves joints through given positions over time.
#pragma once

#include <string>
#include <vector>

#include "control/activity_step.h"

namespace navvy::control {

/// Moves joints through given positions over time (open loop). Positions are interpolated linearly
/// between given times (knots), which count from the start of the step.
struct Trajectory final : ActivityStep {
  /// Positions of one joint, as read from a scene file.
  struct Column {
    /// Name of the joint.
    std::string joint;
    /// Positions of a revolute joint [rad] (degrees in the file), one per knot.
    std::vector<double> degrees;
    /// Positions of a prismatic joint [m], one per knot.
    std::vector<double> metres;
    /// True if the file has positions for a revolute joint (`turns`) or a prismatic joint
    /// (`slides`).
    bool turns = false, slides = false;

    /// Lists the attribute and the child elements of one joint.
    void describe(scene::Fields& f) {
      f.attribute("name", joint, "Joint of the machine.");
      f("positions_deg", degrees, {-36000, 36000}, "Positions of a revolute joint, one per time.",
        scene::given(turns));
      f("positions_m", metres, {-1e4, 1e4}, "Positions of a prismatic joint, one per time.",
        scene::given(slides));
    }
    /// Returns the positions that the file has, [rad] or [m].
    const std::vector<double>& positions() const { return turns ? degrees : metres; }
  };

  /// Name of the step's element in scene files.
  static constexpr const char* kElement = "trajectory";
  /// One-sentence description of the step for the reference of scene elements.
  static constexpr const char* kText =
      "Moves joints through positions over time, linear between them.";
  /// Names of the moved joints.
  std::vector<std::string> joints;
  /// Times of the knots since the start of the step [s], in increasing order.
  std::vector<double> times;
  /// Positions, indexed as [knot][joint] in the orders of `times` and `joints`; [rad] for revolute
  /// and [m] for prismatic joints.
  std::vector<std::vector<double>> positions;
  /// Positions as read from a scene file, one entry per joint. Empty for a step built in C++.
  std::vector<Column> columns;

  /// Lists the child elements of the step with their ranges and descriptions.
  void describe(scene::Fields& f) override {
    f("times_s", times, {0, 1e6}, "Times from the start of the step, increasing.", scene::kNeeded);
    f("joint", columns, limits::kLinks, "Positions of one joint.", scene::kNeeded);
  }
  /// Reports errors in times and joints, and fills `joints` and `positions` from `columns`.
  void check(const scene::StepSource& source);
  /// Returns the name of the step's element in scene files.
  const char* element() const override { return kElement; }
  /// Checks that the machine has the joints, and that there is one position per knot and joint.
  /// Unlike `check`, this also runs for programs built in C++. @throws InputError if not.
  void check_machine(const scene::Machine& machine) const override;
  /// Returns an activity with one phase, "trajectory". It commands only the joints of the
  /// trajectory.
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
};

}  // namespace navvy::control
