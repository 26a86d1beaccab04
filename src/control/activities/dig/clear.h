// SPDX-License-Identifier: Apache-2.0
// The program step `clear`: takes loose bodies out of an area to a place.
#pragma once

#include <memory>
#include <vector>

#include "control/activity_step.h"

namespace navvy::control {

/// Takes the loose bodies, such as stones, that are inside a polygon to a place outside of it, one
/// scoop for each, from where the machine stands: those with no other body behind or in front of
/// them first, and of these the nearest. The edge is drawn through the
/// ground under a body towards the machine, and the bucket is opened over the place.
///
/// A body is cleared if it then is outside the polygon and near the place; otherwise the machine
/// tries again, each time a little deeper. The step falls short if bodies are left, and names them
/// with their places.
struct Clear final : ActivityStep {
  /// Name of the step's element in scene files.
  static constexpr const char* kElement = "clear";
  /// One-sentence description of the step for the reference of scene elements.
  static constexpr const char* kText =
      "Takes loose bodies, such as stones, out of a polygon to a place.";
  /// Coordinates x y in W of the corners [m].
  std::vector<double> polygon_numbers;
  /// Corners in W [m]; the scene reader sets them from `polygon_numbers`.
  std::vector<Vec2> polygon;
  /// Position (x, y) in W at which the bodies are dumped [m].
  Vec2 dump_at = Vec2::Zero();
  /// Height of the bucket's tip above the ground at `dump_at` when the bucket opens [m].
  double dump_height = 0.8;
  /// Depth of the bucket's edge below the ground on the first try [m].
  double depth = 0.1;
  /// Distance from `dump_at` within which a dumped body counts as cleared [m].
  double tolerance = 2;
  /// Largest number of scoops for one body.
  int tries = 3;

  /// Lists the child elements of the step with their ranges and descriptions.
  void describe(scene::Fields& f) override;
  /// Reports an error if the machine cannot dig, for a polygon without an inside, for places off
  /// the site, and for a dump in the polygon or at its edge.
  void check(const scene::StepSource& source);
  /// Returns the name of the step's element in scene files.
  const char* element() const override { return kElement; }
  /// Returns the corners of the polygon and the place of the bodies.
  std::vector<Vec2> places() const override;
  /// Returns true: bodies are taken up with the bucket.
  bool needs_arm() const override { return true; }
  /// Returns an activity whose phases are those of a dig, and "look" after each scoop.
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
  /// Reports an error for a polygon out of reach, for a dump out of reach, and for each body in the
  /// polygon that the arm cannot reach, that is larger than the bucket or too heavy for the arm.
  void check_reach(ReachCheck& check) const override;
  /// Returns the point at which the bodies are dumped.
  std::optional<DumpPoint> dump_point() const override { return DumpPoint{dump_at, dump_height}; }
};

}  // namespace navvy::control
