// SPDX-License-Identifier: Apache-2.0
// The program step `compact`: rolls ground by driving over it, or presses it with the bucket.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "control/activity_step.h"

namespace navvy::control {

/// Makes the ground inside a polygon denser, with the machine's wheels or tracks or with its
/// bucket.
///
/// With wheels the machine drives over the ground, to and fro, along lanes parallel to the longest
/// edge that together cover its width. A lane begins clear of the polygon, at the end that is
/// nearer to the machine, to which it drives straight or along a planned path. With the bucket the
/// machine stands, and presses the bucket's flat bottom on places that together cover the polygon
/// (press_places), until `press` or the limit of the arm or of the machine's weight.
///
/// Lanes and places that fail are left out. The step is done if none is left out. Its measurements
/// include the density of the uppermost 0.3 m before and after.
struct Compact final : ActivityStep {
  /// Name of the step's element in scene files.
  static constexpr const char* kElement = "compact";
  /// One-sentence description of the step for the reference of scene elements.
  static constexpr const char* kText =
      "Rolls the ground inside a polygon by driving over it along lanes, or presses it with the "
      "bucket.";
  /// Part of the machine that compacts the ground: wheels or tracks, or the bucket.
  enum class With : std::uint8_t { kWheels, kBucket };
  /// Coordinates x y of the corners in W [m], as the file lists them.
  std::vector<double> polygon_numbers;
  /// Corners in W (x, y) [m].
  std::vector<Vec2> polygon;
  /// Part of the machine that compacts the ground.
  With with = With::kWheels;
  /// Number of times that each lane is driven, or each place pressed.
  int passes = 4;
  /// Speed of the wheels [m/s].
  double speed = 0.6;
  /// Force of the bucket on the ground at which a press is made [N].
  double press = 0;
  /// True if the scene file gives `press`; otherwise arm and weight limit the force.
  bool has_press = false;

  /// Lists the child elements of the step with their ranges and descriptions.
  void describe(scene::Fields& f) override {
    f("polygon_m", polygon_numbers, {-1e6, 1e6},
      "Coordinates x y in W of the 3 to 1000 corners; edges must not cross.", scene::kNeeded);
    f("with", with, {{"wheels", With::kWheels}, {"bucket", With::kBucket}},
      "Part that compacts the ground: wheels or tracks, or the flat bottom of the bucket.");
    f("passes", passes, {1, 100},
      "Number of times that each lane is driven, or each place pressed.");
    f("speed_m_per_s", speed, {0.05, 20}, "Speed of the wheels.");
    f("press_n", press, {100, 1e7},
      "Force of the bucket at which a press is made; by default what arm and weight can give.",
      scene::given(has_press));
  }
  /// Reports an error for a polygon without an inside, for a machine that lacks drive and wheels,
  /// or arm and bucket, and for elements that belong to the other way to compact.
  void check(const scene::StepSource& source);
  /// Returns the name of the step's element in scene files.
  const char* element() const override { return kElement; }
  /// Returns the corners.
  std::vector<Vec2> places() const override { return polygon; }
  /// Returns true for wheels: the drives to the lanes are planned.
  bool needs_planner() const override { return with == With::kWheels; }
  /// Returns true for the bucket.
  bool needs_arm() const override { return with == With::kBucket; }
  /// Returns an activity with the phases of driving, or with "approach", "press", "lift" and
  /// "look".
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
  /// Reports lanes that end off the site, and places that the bucket does not reach.
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
