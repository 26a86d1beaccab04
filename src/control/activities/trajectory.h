// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "control/activity_step.h"

namespace navvy::control {

/// Moves joints along open-loop positions over time, linear between knots; times count from the
/// start of this step.
struct Trajectory final : ActivityStep {
  /// Positions of one joint, as a file gives them.
  struct Column {
    std::string joint;
    std::vector<double> degrees;  ///< [rad]
    std::vector<double> metres;   ///< [m]
    bool turns = false, slides = false;

    void describe(scene::Fields& f) {
      f.attribute("name", joint, "Joint of the machine.");
      f("positions_deg", degrees, {-36000, 36000}, "Positions of a revolute joint, one per time.",
        scene::given(turns));
      f("positions_m", metres, {-1e4, 1e4}, "Positions of a prismatic joint, one per time.",
        scene::given(slides));
    }
    const std::vector<double>& positions() const { return turns ? degrees : metres; }
  };

  /// Name in scene files.
  static constexpr const char* kElement = "trajectory";
  /// Sentence for the reference of scene elements.
  static constexpr const char* kText =
      "Moves joints through positions over time, linear between them.";
  std::vector<std::string> joints;
  /// Times of the knots [s], increasing.
  std::vector<double> times;
  /// Positions as [knot][joint], [rad] or [m].
  std::vector<std::vector<double>> positions;
  /// Positions as read, one entry per joint.
  std::vector<Column> columns;

  void describe(scene::Fields& f) override {
    f("times_s", times, {0, 1e6}, "Times from the start of the step, increasing.", scene::kNeeded);
    f("joint", columns, limits::kLinks, "Positions of one joint.", scene::kNeeded);
  }
  /// Checks times and joints, and fills `joints` and `positions` from `columns`.
  void check(const scene::StepSource& source);
  const char* element() const override { return kElement; }
  /// Checks the trajectory against the machine. @throws InputError also for anything that the
  /// reader would have refused.
  void check_machine(const scene::Machine& machine) const override;
  /// Returns an activity with one phase, which commands only its joints.
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
};

}  // namespace navvy::control
