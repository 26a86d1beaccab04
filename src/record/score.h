// SPDX-License-Identifier: Apache-2.0
// Score of a run: what a job achieved against its design, and at what cost.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "record/earthwork.h"
#include "scene/goals.h"
#include "session/session.h"
#include "sim/world_terrain.h"

namespace navvy::record {

/// Mean and spread of a sample.
struct Spread {
  /// Number of values.
  int count = 0;
  /// Mean, and standard deviation of the sample; 0 without values.
  double mean = 0, spread = 0;
};
/// Returns mean and spread of `values`.
Spread spread_of(const std::vector<double>& values);

/// Digging cycles of one machine by segment.
struct CycleScore {
  /// Times [s]: dig (from the start of the scoop until the bucket is lifted out), swing loaded,
  /// dump, swing empty (until the next scoop from the same place), and the whole from scoop to
  /// scoop.
  Spread dig, swing_loaded, dump, swing_empty, whole;
  /// Mass of the soil in the bucket when the dump starts [kg].
  Spread payload;
  /// Bucket fill factor: loose volume over the heaped capacity [-].
  Spread fill_factor;
};

/// Work of one machine.
struct MachineScore {
  /// Index of the machine in scene::Scene::machines.
  int machine = 0;
  /// Number of digging cycles.
  int cycles = 0;
  /// Cycles by segment.
  CycleScore cycle;
  /// Distance driven [m]; session::Travel.
  double distance = 0;
  /// Number of places from which the machine dug.
  int stations = 0;
  /// Area on level ground that the machine can dig in from one place: the ring about the swing axis
  /// between the nearest and the farthest reach [m2]; 0 without an arm.
  double reach_area = 0;
  /// Work of its drives and cylinders [J].
  double work = 0;
};

/// Volumes between the ground at the start and now, and masses that columns lost and gained.
struct AreaScore {
  /// Volumes by height: where the ground is lower, and where it is higher than at the start [m3].
  double cut = 0, fill = 0;
  /// The parts of these volumes in columns whose mass has changed by less than a twentieth of a
  /// cell: ruts of wheels, and soil that was pressed or pushed up [m3].
  double rut_cut = 0, rut_fill = 0;
  /// Sums over the columns that lost, and over those that gained mass [kMassQuantum].
  std::int64_t lost = 0, gained = 0;
};

/// Ground against its design, over all columns that have a design height.
struct ShapeScore {
  /// Area of the design, and of the part of it that is to be cut [m2].
  double area = 0, cut_area = 0;
  /// Volumes from the start to the design [m3].
  double design_cut = 0, design_fill = 0;
  /// Share of the commanded volumes that is done, each column at most to its design height [-].
  double completion = 0;
  /// Share of the commanded area on which the design height is reached within kCovered [-].
  double coverage = 0;
  /// Dug volume minus the commanded one, relative to the commanded one [-].
  double volume_error = 0;
  /// Depth below, and height above the design: root mean squares over the area, and largest [m].
  double over_rms = 0, over_max = 0, under_rms = 0, under_max = 0;
  /// Root mean square of the difference of ground and design [m].
  double rms = 0;
  /// Angle of the sides by regression of the ground's heights on the design's, and of the design's
  /// own sides [rad]; nothing if fewer than 20 columns are sides.
  std::optional<double> batter, design_batter;
};
/// Height above a design within which a column counts as done [m].
inline constexpr double kCovered = 0.1;

/// Trucks that jobs have loaded.
struct LoadScore {
  /// Number of loads.
  int count = 0;
  /// Largest difference of a load from the wanted one, relative to it [-].
  double error = 0;
  /// Largest distance of a load's centre of mass from the middle of its bed, in plan [m].
  double offset = 0;
  /// Most passes of a load.
  int passes = 0;
  /// Mass that left the bucket over the beds and fell beside them [kg].
  double spilt = 0;
};

/// Score of a run up to now.
struct Score {
  /// Ground against its design; nothing without one.
  std::optional<ShapeScore> shape;
  /// Columns with a design height, and all others.
  AreaScore inside, outside;
  /// Trucks that were loaded; nothing without a job that loads any.
  std::optional<LoadScore> loads;
  /// Bank volume of the soil that columns lost [m3] (Earthwork::bank_volume).
  double bank_volume = 0;
  /// Mass of the soil in buckets when dumps started, summed over all cycles [kg].
  double moved = 0;
  /// Simulated time until the last program ended, or until now [s].
  double work_time = 0;
  /// Work of all machines [J].
  double energy = 0;
  /// Number of collisions.
  std::int64_t collisions = 0;
  /// Difference between the masses above and the mass ledger [kMassQuantum]; 0 if they agree.
  std::int64_t balance_error = 0;
  /// Machines that dug or drove, in the order of the scene.
  std::vector<MachineScore> machines;
  /// Number of all places from which machines dug, and sum of their reach areas [m2].
  int stations = 0;
  double reach_area = 0;
  /// Distance that the machines that dug have driven [m].
  double base_moves = 0;
};

/// Returns the score of a run. `active` holds the places of the active soil now, and `earth` the
/// earth moved. Costs passes over the changed columns.
Score measure_score(const session::Session& session, const sim::ActivePlaces& active,
                    const Earthwork& earth);
/// Returns the score of a run. Determines places and earth itself, with a pass over all particles.
Score measure_score(const session::Session& session);

/// Judgement of one goal.
struct GoalResult {
  /// Name of the goal's element, with its unit: "over_dig_rms_m".
  std::string name;
  /// Measured value, in the unit of the name; nothing if it cannot be measured.
  std::optional<double> value;
  /// Bound, in the unit of the name.
  double bound = 0;
  /// True if the bound is the least allowed value; false if it is the largest.
  bool at_least = false;
  /// True if the goal is met; a value that cannot be measured misses it.
  bool met = false;
  /// Why the value cannot be measured; empty if it can.
  std::string reason;
  /// Returns the judgement as a sentence.
  std::string text() const;
};
/// Returns a judgement for each goal that the scene sets.
std::vector<GoalResult> judge(const Score& score, const scene::Goals& goals);

}  // namespace navvy::record
