// SPDX-License-Identifier: Apache-2.0
// Results of steps and programs: states, reasons and measurements. The summary of a run reports
// them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/archive.h"
#include "core/math.h"

namespace navvy::control {

/// State of a program step. All values after kDone are failures: the step did not reach its aim,
/// and the program ends or goes on at the next if_short.
enum class StepState : std::uint8_t {
  /// The step is in progress.
  kRunning,
  /// The step has reached its aim.
  kDone,
  /// An obstacle holds the machine, or the event that the step waits for can no longer occur.
  kBlocked,
  /// The machine works without making progress: wheels spin, or scoops come up empty.
  kStalled,
  /// The machine has rolled or pitched over.
  kTipped,
  /// The target cannot be reached from the machine's position.
  kOutOfReach,
  /// The time limit of the step, or the duration of the run, was reached first.
  kOutOfTime,
  /// The machine has sunk into the ground, or soil covers it.
  kBuried,
  /// The planner found no path to the target.
  kNoPath,
  /// The machine slid or was pushed away during a step in which it stands.
  kMoved,
  /// The machine's base has left the site.
  kOffSite,
  /// Another program was ordered before the step ended.
  kReplaced,
};

/// Returns the name of a state as used in files and messages, such as "out_of_reach".
const char* name_of(StepState state);
/// Returns true if the step has failed, that is, it ended without reaching its aim.
inline bool fell_short(StepState state) { return state > StepState::kDone; }

/// A named measurement that a step reports.
struct Measurement {
  /// Name as in summary.json, with the unit as its suffix: "depth_reached_m".
  std::string name;
  /// Value in the unit that the name ends in.
  double value = 0;

  /// Saves or loads name and value.
  void visit(Archive& a);
};

/// Result of one step of a program.
struct StepReport {
  /// Position of the step in the program, counted from 1; 0 if the report belongs to no step.
  std::int64_t step = 0;
  /// Name of the step's element in scene files, such as "drive_to".
  std::string element;
  /// State in which the step ended, or kRunning.
  StepState state = StepState::kRunning;
  /// Explanation of the state as a sentence. Empty if there is nothing to explain.
  std::string reason;
  /// Simulated times at which the step started and ended [s]. While the step runs, `end` is the
  /// current time.
  double start = 0, end = 0;
  /// Position of the base link's origin in W [m] at the time `end`.
  Vec3 place = Vec3::Zero();
  /// Measurements that the step itself reports (Activity::account).
  std::vector<Measurement> measurements;

  /// Saves or loads all fields.
  void visit(Archive& a);
};

}  // namespace navvy::control
