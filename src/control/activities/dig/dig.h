// SPDX-License-Identifier: Apache-2.0
// The program step `dig`: digs a straight trench.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "control/activity_step.h"
#include "control/observation.h"

namespace navvy::control {

/// Digs a straight trench in cycles (scoop, swing, dump, return) until the commanded depth and
/// length are reached.
///
/// Digging ends when no soil worth a scoop is left, after three empty scoops in a row, or after the
/// maximum number of cycles. The step is done if at most 15 % of the commanded volume is left, or
/// if it made the number of cycles that the scene sets; otherwise it fails. With a load for the bed
/// of another machine it is done when the bed holds it, and fails if the trench ends before. Its
/// measurements include the volume left and the depth reached.
struct Dig final : ActivityStep {
  /// Name of the step's element in scene files.
  static constexpr const char* kElement = "dig";
  /// One-sentence description of the step for the reference of scene elements.
  static constexpr const char* kText =
      "Digs a straight trench by whole cycles, until floor and length are reached.";
  /// Ends of the trench's centre line in W (x, y) [m]. Either one may be farther from the machine.
  Vec2 from = Vec2::Zero(), to = Vec2::Zero();
  /// Depth of the trench below the ground surface as it is when the step starts [m].
  double depth = 0.8;
  /// Width of the trench [m]; the scene reader sets the width of the bucket by default.
  double width = 1.05;
  /// Position (x, y) in W at which the soil is dumped [m].
  Vec2 dump_at = Vec2::Zero();
  /// Height of the bucket's tip above the ground at `dump_at` when the bucket opens [m].
  double dump_height = 1.5;
  /// Name of the machine in whose bed the soil of each cycle must land; empty: the ground.
  std::string into;
  /// True if the scene file gives `into`.
  bool has_into = false;
  /// Mass of soil in the beds of `into` at which the step is done [kg]; used if `has_load`.
  double load = 0;
  bool has_load = false;
  /// Maximum depth of soil that one pass removes [m]. Within it, the plan chooses the slices so
  /// that buckets come out full.
  double pass_depth = 0.5;
  /// Bucket fill factor that a scoop aims at: loose volume over the heaped capacity [-]. Used if
  /// `has_fill`; else the soil decides (usual_fill).
  double fill = 1;
  bool has_fill = false;
  /// Number of cycles after which the step is done. If empty, digging goes on until the trench is
  /// done, for 60 cycles at most.
  std::optional<int> max_cycles;
  /// Heights of the floor in W at equal distances from the end nearer to the machine to the other
  /// one [m]; `depth` is then the largest depth below the present ground. Empty: a level trench.
  /// Not an element of scenes: a job sets it for its cuts.
  std::vector<double> floor;
  /// Height in W above which the bucket swings [m]; used if `is_cut`.
  double rim = 0;
  /// Share of a full bucket below which the rest of a cut stays; used if `is_cut`.
  double worth = 0.3;
  /// True for one pass along the whole floor, whatever it brings. Not an element of scenes either.
  bool levels = false;
  /// Half of the line about `dump_at` over which the passes of a load are spread, in W [m]; zero:
  /// all at one place. Not an element of scenes.
  Vec2 spread = Vec2::Zero();
  /// Gain that loading a bed has taught, kept from dig to dig (DiggingMemory::gain); null: each dig
  /// begins with 1. Not an element of scenes.
  double* gain = nullptr;
  /// Returns true while the bucket holds a body, which the dump waits for as for soil; empty: the
  /// bucket holds soil only. Not an element of scenes.
  std::function<bool(const Observation&)> holds;
  /// Returns true for a cut of a job: soil that is left is no failure, and the floor is not cleaned
  /// up.
  bool is_cut() const { return !floor.empty(); }

  /// Lists the child elements of the step with their ranges and descriptions.
  void describe(scene::Fields& f) override {
    f("from_m", from, {-1e6, 1e6}, "One end of the trench's centre line in W.", scene::kNeeded);
    f("to_m", to, {-1e6, 1e6}, "The other end.", scene::kNeeded);
    f("depth_m", depth, {0.02, 20}, "Depth below the ground at the start.", scene::kNeeded);
    f("width_m", width, {0.05, 50}, "Width; by default that of the bucket's cut.");
    f("dump_at_m", dump_at, {-1e6, 1e6}, "Place of the spoil in W.", scene::kNeeded);
    f("dump_height_m", dump_height, {0.1, 10}, "Height of the tip over the ground there.");
    f("into", into, "Machine in whose bed the soil must land; the step fails when it does not.",
      scene::given(has_into));
    f("load_kg", load, {1, 1e6},
      "Mass of soil in the beds of `into` at which the step is done; the last passes are alike.",
      scene::given(has_load));
    f("pass_depth_m", pass_depth, {0.02, 5}, "Largest depth of one pass.");
    f("fill", fill, {0.1, 1.5},
      "Loose volume to fill the bucket with, over its heaped capacity; by default that of the "
      "soil.",
      scene::given(has_fill));
    f("max_cycles", max_cycles, {1, 100000},
      "Number of cycles; by default until the trench is done, at most 60.");
  }
  /// Reports an error if the machine cannot dig, if the trench or the dump point is not on the
  /// site, or if the trench is deeper than the ground. Also sets the default of `width`.
  void check(const scene::StepSource& source);
  /// Returns the name of the step's element in scene files.
  const char* element() const override { return kElement; }
  /// Returns the ends of the trench and the place of the spoil.
  std::vector<Vec2> places() const override { return {from, to, dump_at}; }
  /// Returns true: digging uses the arm.
  bool needs_arm() const override { return true; }
  /// Returns an activity with the phases of the digging cycle, followed by a final look at the
  /// trench.
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
  /// Reports an error for each part of the trench and of the dump that the arm cannot reach.
  void check_reach(ReachCheck& check) const override;
  /// Returns the point at which the step dumps the soil.
  std::optional<DumpPoint> dump_point() const override { return DumpPoint{dump_at, dump_height}; }
  /// Returns `into`.
  std::vector<std::string> receivers() const override {
    return into.empty() ? std::vector<std::string>{} : std::vector{into};
  }
};

}  // namespace navvy::control
