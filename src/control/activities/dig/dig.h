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
  static constexpr const char* kText =
      "Digs a straight trench by whole cycles, until floor and length are reached.";
  Vec2 from = Vec2::Zero(),
       /// Ends of the centre line at the surface [m] in W; far end first or not.
      to = Vec2::Zero();
  double depth = 0.8;             ///< below the surface at the start [m]
  double width = 1.05;            ///< one bucket wide by default [m]
  Vec2 dump_at = Vec2::Zero();    ///< where the spoil goes [m] in W
  double dump_height = 1.5;       ///< tip clearance over the ground there [m]
  double pass_depth = 0.25;       ///< depth of one slice [m]
  std::optional<int> max_cycles;  ///< so many and no more; without, until the trench is done

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
  /// Digging: phases of the cycle, and a look round at the end.
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
  void check_reach(ReachCheck& check) const override;
  std::optional<DumpPoint> dump_point() const override { return DumpPoint{dump_at, dump_height}; }
};

}  // namespace navvy::control
