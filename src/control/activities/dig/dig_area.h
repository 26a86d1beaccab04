// SPDX-License-Identifier: Apache-2.0
// The program step `dig_area`: digs a pit of a given shape from several stations.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "control/activity_step.h"
#include "control/job_planner.h"

namespace navvy::control {

/// Digs a pit with a level floor inside a polygon and battered sides. The pit may be wider than the
/// bucket and larger than the arm's reach.
///
/// A job planner (JobPlanner) chooses the stations. At each one the machine digs radial strips one
/// bucket wide, layer by layer, as the ground then is, and backs to the next one. Between stations
/// it drives straight; to the first one along a planned path where straight does not lead there.
///
/// The step is done if at most 15 % of the commanded volume is left. A cut that fails is left out.
/// A straight drive that fails is tried once more along a planned path, and then its station is
/// left out.
struct DigArea : ActivityStep {
  /// Name of the step's element in scene files.
  static constexpr const char* kElement = "dig_area";
  /// One-sentence description of the step for the reference of scene elements.
  static constexpr const char* kText =
      "Digs a pit inside a polygon, with battered sides, layer by layer from several stations.";
  /// Coordinates x y of the floor's corners in W [m], as the file lists them.
  std::vector<double> polygon_numbers;
  /// Corners of the floor in W (x, y) [m].
  std::vector<Vec2> polygon;
  /// Depth of the floor at the first corner below the ground at the start [m].
  double depth = 1;
  /// Angle by which the floor falls [rad], and the direction in which it does, from W's x [rad].
  /// Only a grade has them.
  double fall = 0, fall_yaw = 0;
  /// Deviation from the design above which a strip of the floor is levelled [m]; 0, as for all but
  /// a grade: it is not levelled.
  double tolerance = 0;
  /// Height above the area up to which it is filled [m]. Only a backfill has it.
  double over = 0;
  /// Angle of the sides from the horizontal [rad]; pi/2: vertical.
  double batter = radians(45);
  /// Ends (x, y) in W of the windrow in which the soil is dumped [m].
  Vec2 dump_at = Vec2::Zero(), dump_to = Vec2::Zero();
  /// True if the scene file gives `dump_to`; without it the soil is dumped in a heap at `dump_at`.
  bool has_dump_to = false;
  /// Coordinates x y x y of the ends of a second windrow in W [m], as the file lists them; empty:
  /// there is none.
  std::vector<double> second_windrow;
  /// Height of the bucket's tip above the ground when the bucket opens [m].
  double dump_height = 1.5;
  /// Largest depth of a layer [m].
  double pass_depth = 0.5;
  /// Bucket fill factor that a scoop aims at; used if `has_fill`, else the soil decides.
  double fill = 1;
  bool has_fill = false;
  /// Speed between stations [m/s].
  double speed = 0.6;
  /// Heap from which the area is filled, or from which trucks are loaded.
  std::optional<JobHeap> heap;
  /// Machines in whose beds the soil must land, as the file lists them and one by one; none: it is
  /// dumped on the ground.
  std::string into_names;
  std::vector<std::string> into;
  /// Mass to which each of their beds is loaded [kg]. True if the scene file gives it.
  double load = 0;
  bool has_load = false;
  /// Time for which the machine waits for a truck [s].
  double longest = 3600;
  /// Number of loads after which the step is done; empty: when the pit is dug.
  std::optional<int> loads;

  /// Lists the child elements of the step with their ranges and descriptions.
  void describe(scene::Fields& f) override {
    f("polygon_m", polygon_numbers, {-1e6, 1e6},
      "Coordinates x y in W of the 3 to 1000 corners of the floor; edges must not cross.",
      scene::kNeeded);
    f("depth_m", depth, {0.1, 20}, "Depth of the floor below the ground at the first corner.",
      scene::kNeeded);
    describe_work(f);
  }
  /// Reports an error if the machine cannot dig or drive, for a polygon without an inside, for
  /// places off the site, and for a pit deeper than the ground.
  void check(const scene::StepSource& source);
  /// Returns the name of the step's element in scene files.
  const char* element() const override { return kElement; }
  /// Returns the pit.
  std::optional<scene::DesignArea> area() const override;
  /// Returns the corners of the floor and the ends of the windrow.
  std::vector<Vec2> places() const override;
  /// Returns true: digging uses the arm.
  bool needs_arm() const override { return true; }
  /// Returns true: the drive to the first station is planned.
  bool needs_planner() const override { return true; }
  /// Returns true: a job planner chooses stations and cuts.
  bool needs_job_planner() const override { return true; }
  /// Returns an activity with the phases of driving and digging.
  std::unique_ptr<Activity> activity(OperatorContext& place) const override;
  /// Reports the faults of the job planner's plan, and its stations as notes.
  void check_reach(ReachCheck& check) const override;
  /// Returns the job for the job planner.
  std::optional<PitJob> pit_job() const override { return job(); }
  /// Returns the beginning of the windrow.
  std::optional<DumpPoint> dump_point() const override { return DumpPoint{dump_at, dump_height}; }

  /// Returns the machines in whose beds the soil must land.
  std::vector<std::string> receivers() const override { return into; }

  /// Returns the job for the job planner.
  PitJob job() const;

 protected:
  /// Lists the child elements of a job that loads trucks.
  void describe_trucks(scene::Fields& f, scene::Mark mark = {}) {
    f("into", into_names,
      "Machines that are loaded in turn, separated by spaces: each one that stands within reach.",
      mark);
    f("load_kg", load, {1, 1e6}, "Mass of soil in the beds of each at which it is loaded.",
      scene::given(has_load));
    f("longest_s", longest, {0, 1e6}, "Longest time to wait for a machine to load.");
  }
  /// Lists the bucket fill factor.
  void describe_fill(scene::Fields& f) {
    f("fill", fill, {0.1, 1.5},
      "Loose volume to fill the bucket with, over its heaped capacity; by default that of the "
      "soil.",
      scene::given(has_fill));
  }
  /// Lists the child elements that every job has.
  void describe_work(scene::Fields& f) {
    f("batter_deg", batter, {15, 90}, "Angle of the sides from the horizontal; 90: vertical.");
    f("dump_at_m", dump_at, {-1e6, 1e6}, "Place of the spoil in W.", scene::kNeeded);
    f("dump_to_m", dump_to, {-1e6, 1e6},
      "Other end of a windrow that begins at dump_at_m; without it the spoil is a heap.",
      scene::given(has_dump_to));
    f("second_windrow_m", second_windrow, {-1e6, 1e6},
      "Ends x y x y of a second windrow, such as one on the other side.");
    f("dump_height_m", dump_height, {0.1, 10}, "Height of the tip over the ground there.");
    f("pass_depth_m", pass_depth, {0.1, 5}, "Largest depth of a layer.");
    describe_fill(f);
    f("speed_m_per_s", speed, {0.05, 20}, "Speed between stations.");
    describe_trucks(f);
  }
};

}  // namespace navvy::control
