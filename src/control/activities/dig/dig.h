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

  /// Reads <from_m>, <to_m>, <depth_m>, <dump_at_m> and the elements with defaults. All positions
  /// must be on the site, the depth above rock.
  static Dig read(const scene::StepSource& source);
  const char* element() const override { return kElement; }
  bool needs_arm() const override { return true; }
  /// Returns an activity with the phases of the digging cycle, and a last look at the trench.
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
  void check_reach(ReachCheck& check) const override;
  std::optional<DumpPoint> dump_point() const override { return DumpPoint{dump_at, dump_height}; }
};

}  // namespace navvy::control
