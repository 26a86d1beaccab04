// SPDX-License-Identifier: Apache-2.0
// The program step `backfill`: fills a hole from a heap or windrow beside it.
#pragma once

#include "control/activities/dig/dig_area.h"
#include "control/activities/dig/heap_source.h"

namespace navvy::control {

/// Fills the ground inside a polygon up to a plane with soil from a heap or windrow beside it. The
/// machine works forwards along the longest edge: from each station it fills the next 3 m ahead of
/// it, the largest hollow first, each scoop no larger than that hollow, takes off what lies too
/// high, and drives on over its fill. Then it backs over the same places, and at each one takes off
/// the ridge that the strips of the place ahead have left at their near ends.
///
/// The step is done if at most 15 % of what the hole lacked is missing and the ground deviates from
/// the plane, raised by `over`, by at most twice the tolerance.
struct Backfill final : DigArea {
  /// Name of the step's element in scene files.
  static constexpr const char* kElement = "backfill";
  /// One-sentence description of the step for the reference of scene elements.
  static constexpr const char* kText =
      "Fills the ground inside a polygon up to a plane, with soil from a heap or windrow beside "
      "it.";
  /// Fills up to the ground at the start.
  Backfill() {
    depth = 0;
    batter = radians(90);
    tolerance = 0.05;
    dump_height = 0.8;
  }
  /// Source of the soil.
  HeapSource source;

  /// Lists the child elements of the step with their ranges and descriptions.
  void describe(scene::Fields& f) override {
    f("polygon_m", polygon_numbers, {-1e6, 1e6},
      "Coordinates x y in W of the 3 to 1000 corners of the fill; edges must not cross.",
      scene::kNeeded);
    f("below_m", depth, {0, 20},
      "Depth of the filled ground below the ground at the start, at the first corner.");
    f("fall_deg", fall, {0, 30}, "Angle by which the filled ground falls.");
    f("fall_yaw_deg", fall_yaw, {-360, 360}, "Direction of the fall, from W's x.");
    f("over_m", over, {0, 0.5},
      "Height above that ground up to which it is filled: what a compact that follows will "
      "settle.");
    source.describe(f);
    f("tolerance_m", tolerance, {0.005, 1},
      "Height (rms) over the plane above which a strip is taken off.");
    f("dump_height_m", dump_height, {0.1, 10}, "Height of the tip over the ground at the dump.");
    f("pass_depth_m", pass_depth, {0.1, 5}, "Largest depth of a layer of the heap.");
    describe_fill(f);
    f("speed_m_per_s", speed, {0.05, 20}, "Speed between stations.");
  }
  /// Reports errors as a dig_area does, and a heap off the site.
  void check(const scene::StepSource& read) {
    // Where a dig_area has its spoil, this step has a corner of the fill.
    dump_at = dump_to =
        polygon_numbers.size() < 2 ? source.from : Vec2(polygon_numbers[0], polygon_numbers[1]);
    DigArea::check(read);
    source.check(read);
    heap = source.heap();
  }
  /// Returns the name of the step's element in scene files.
  const char* element() const override { return kElement; }
  /// Returns the corners of the fill and the ends of the windrow.
  std::vector<Vec2> places() const override {
    std::vector<Vec2> out = source.places();
    out.insert(out.end(), polygon.begin(), polygon.end());
    return out;
  }
  /// Returns nothing: the step digs no pit.
  std::optional<PitJob> pit_job() const override { return std::nullopt; }
  /// Returns the first corner of the fill.
  std::optional<DumpPoint> dump_point() const override {
    return DumpPoint{polygon.empty() ? source.from : polygon.front(), dump_height};
  }
};

}  // namespace navvy::control
