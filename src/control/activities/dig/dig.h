// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "control/program_step.h"

namespace navvy::control {

/// Dig a straight trench by whole cycles (scoop, swing, dump, return) until floor and length are
/// reached.
///
/// Ends when nothing worthwhile is left, after three empty scoops in a row, or after the cycles it
/// was ordered. It is done when little is left of the design, or all its cycles were made; its
/// account tells what is left and how deep it came.
struct Dig final : ProgramStep {
  static constexpr const char* kElement = "dig";
  Vec2 from = Vec2::Zero(),
       /// Ends of the centre line at the surface [m] in W; far end first or not.
      to = Vec2::Zero();
  double depth = 0.8;             ///< below the surface at the start [m]
  double width = 1.05;            ///< one bucket wide by default [m]
  Vec2 dump_at = Vec2::Zero();    ///< where the spoil goes [m] in W
  double dump_height = 1.5;       ///< tip clearance over the ground there [m]
  double pass_depth = 0.25;       ///< depth of one slice [m]
  std::optional<int> max_cycles;  ///< so many and no more; without, until the trench is done

  /// Elements: <from_m>, <to_m>, <depth_m>, <dump_at_m> and what has a default; all places must lie
  /// on the site, the depth above rock.
  static Dig read(const scene::StepSource& source);
  const char* element() const override { return kElement; }
  bool needs_arm() const override { return true; }
  /// Digging: phases of the cycle, and a look round at the end.
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
  void check_reach(ReachCheck& check) const override;
  std::optional<DumpPoint> dump_point() const override { return DumpPoint{dump_at, dump_height}; }
};

}  // namespace navvy::control
