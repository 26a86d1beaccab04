// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "control/activity_step.h"

namespace navvy::control {

/// Digs a straight trench by whole cycles (scoop, swing, dump, return) until depth and length are
/// reached.
///
/// Ends when nothing worthwhile is left, after three empty scoops in a row, or after the commanded
/// number of cycles. The step is done when little of the design is left, or all its cycles were
/// made; its account reports what is left and the depth reached.
struct Dig final : ActivityStep {
  static constexpr const char* kElement = "dig";
  /// Sentence for the reference of scene elements.
  static constexpr const char* kText =
      "Digs a straight trench by whole cycles, until floor and length are reached.";
  /// Ends of the centre line at the surface [m] in W; either may be the far end.
  Vec2 from = Vec2::Zero(), to = Vec2::Zero();
  /// Depth below the surface at the start [m].
  double depth = 0.8;
  /// Width, one bucket by default [m].
  double width = 1.05;
  /// Position of the spoil heap [m] in W.
  Vec2 dump_at = Vec2::Zero();
  /// Clearance of the tip over the ground there [m].
  double dump_height = 1.5;
  /// Depth of one slice [m].
  double pass_depth = 0.25;
  /// Largest number of cycles; without it, until the trench is done.
  std::optional<int> max_cycles;

  void describe(scene::Fields& f) override {
    f("from_m", from, {-1e6, 1e6}, "One end of the trench's centre line in W.", scene::kNeeded);
    f("to_m", to, {-1e6, 1e6}, "The other end.", scene::kNeeded);
    f("depth_m", depth, {0.02, 20}, "Depth below the ground at the start.", scene::kNeeded);
    f("width_m", width, {0.05, 50}, "Width; by default that of the bucket's cut.");
    f("dump_at_m", dump_at, {-1e6, 1e6}, "Place of the spoil in W.", scene::kNeeded);
    f("dump_height_m", dump_height, {0.1, 10}, "Height of the tip over the ground there.");
    f("pass_depth_m", pass_depth, {0.02, 5}, "Depth of one pass.");
    f("max_cycles", max_cycles, {1, 100000},
      "Number of cycles; by default until the trench is done, at most 60.");
  }
  /// Checks that the machine can dig and that trench and spoil are on the site and above rock.
  void check(const scene::StepSource& source);
  const char* element() const override { return kElement; }
  bool needs_arm() const override { return true; }
  /// Returns an activity with the phases of the digging cycle, and a last look at the trench.
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
  void check_reach(ReachCheck& check) const override;
  std::optional<DumpPoint> dump_point() const override { return DumpPoint{dump_at, dump_height}; }
};

}  // namespace navvy::control
