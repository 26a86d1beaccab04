// SPDX-License-Identifier: Apache-2.0
// The program step `compact`: rolls ground by driving over it.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "control/activity_step.h"

namespace navvy::control {

/// Rolls the ground inside a polygon with the machine's wheels or tracks: drives over it, to and
/// fro, along lanes parallel to the longest edge that together cover its width. A lane begins clear
/// of the polygon, at the end that is nearer to the machine, to which it drives straight or along a
/// planned path.
///
/// A lane that cannot be driven is left out. The step is done if no lane is left out. Its
/// measurements include the density of the uppermost 0.3 m before and after.
struct Compact final : ActivityStep {
  /// Name of the step's element in scene files.
  static constexpr const char* kElement = "compact";
  /// One-sentence description of the step for the reference of scene elements.
  static constexpr const char* kText =
      "Rolls the ground inside a polygon by driving over it along lanes.";
  /// Coordinates x y of the corners in W [m], as the file lists them.
  std::vector<double> polygon_numbers;
  /// Corners in W (x, y) [m].
  std::vector<Vec2> polygon;
  /// Number of times that each lane is driven.
  int passes = 4;
  /// Speed [m/s].
  double speed = 0.6;

  /// Lists the child elements of the step with their ranges and descriptions.
  void describe(scene::Fields& f) override {
    f("polygon_m", polygon_numbers, {-1e6, 1e6},
      "Coordinates x y in W of the 3 to 1000 corners; edges must not cross.", scene::kNeeded);
    f("passes", passes, {1, 100}, "Number of times that each lane is driven.");
    f("speed_m_per_s", speed, {0.05, 20}, "Speed.");
  }
  /// Reports an error for a polygon without an inside, or if the machine has no drive or wheels.
  void check(const scene::StepSource& source);
  /// Returns the name of the step's element in scene files.
  const char* element() const override { return kElement; }
  /// Returns the corners.
  std::vector<Vec2> places() const override { return polygon; }
  /// Returns true: the drives to the lanes are planned.
  bool needs_planner() const override { return true; }
  /// Returns an activity with the phases of driving.
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
  /// Reports lanes that end off the site.
  void check_reach(ReachCheck& check) const override;
};

/// A lane of a compact step: poses of the base at both ends, with the same heading.
struct RollerLane {
  PlanePose from;
  PlanePose to;
};

/// Returns lanes whose wheel tracks cover a polygon, from one side to the other, for a machine that
/// heads in the direction `yaw` [rad]: it turns by less than a right angle. Empty for a machine
/// without wheels.
std::vector<RollerLane> roller_lanes(const scene::Machine& machine,
                                     const std::vector<Vec2>& polygon, double yaw);

}  // namespace navvy::control
