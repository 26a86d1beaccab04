// SPDX-License-Identifier: Apache-2.0
// The program step `grade`: cuts ground down to a plane and levels it.
#pragma once

#include "control/activities/dig/dig_area.h"

namespace navvy::control {

/// Cuts the ground inside a polygon down to a plane, from several stations as a dig_area, and then
/// levels it: the bucket's edge is drawn along every strip of the floor that deviates from the
/// plane by more than the tolerance (rms), three times at most from one station.
///
/// The step is done if at most 15 % of the commanded volume is left and the ground deviates from
/// the design by at most twice the tolerance. It fills no hollow.
struct Grade final : DigArea {
  /// Name of the step's element in scene files.
  static constexpr const char* kElement = "grade";
  /// One-sentence description of the step for the reference of scene elements.
  static constexpr const char* kText =
      "Cuts the ground inside a polygon down to a plane and levels it, from several stations.";
  /// Makes a shallow cut with a tolerance.
  Grade() {
    depth = 0.1;
    tolerance = 0.03;
  }

  /// Lists the child elements of the step with their ranges and descriptions.
  void describe(scene::Fields& f) override {
    f("polygon_m", polygon_numbers, {-1e6, 1e6},
      "Coordinates x y in W of the 3 to 1000 corners of the plane; edges must not cross.",
      scene::kNeeded);
    f("depth_m", depth, {0.02, 5}, "Depth of the plane below the ground at the first corner.");
    f("fall_deg", fall, {0, 30}, "Angle by which the plane falls.");
    f("fall_yaw_deg", fall_yaw, {-360, 360}, "Direction of the fall, from W's x.");
    f("tolerance_m", tolerance, {0.005, 1},
      "Deviation (rms) from the plane above which a strip is levelled.");
    describe_work(f);
  }
  /// Reports errors as a dig_area, and a tolerance that is not below the depth: nothing would be
  /// dug.
  void check(const scene::StepSource& source) {
    DigArea::check(source);
    if (!(tolerance < depth))
      source.error("tolerance_m", source.written("tolerance_m"), "must be below depth_m",
                   "at most half of it");
  }
  /// Returns the name of the step's element in scene files.
  const char* element() const override { return kElement; }
};

}  // namespace navvy::control
