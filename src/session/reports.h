// SPDX-License-Identifier: Apache-2.0
// Results of the programs of a run: digging cycles, bed tips, forces, and the outcome of each
// program.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "control/outcome.h"
#include "control/path.h"
#include "core/archive.h"
#include "core/math.h"

namespace navvy::session {

/// One digging cycle (dig, swing, dump) of a machine. It begins when the bucket starts to move down
/// into the ground, and ends when the bucket is empty.
struct Cycle {
  /// Index of the machine in scene::Scene::machines.
  int machine = 0;
  /// Simulated times [s] of the events of the cycle: start of the scoop (kScoopStart), start of the
  /// curl (kCurlStart), bucket lifted out of the ground (kLiftOut), start of the dump (kDumpStart),
  /// and end (kCycleEnd).
  double start = 0, curl = 0, lift_out = 0, dump_start = 0, end = 0;
  /// Mass of the soil in the bucket at the times `lift_out` and `dump_start` [kg].
  double payload_lift_out = 0, payload_dump = 0;
  /// Maximum magnitude of the low-pass filtered soil force on the bucket during the cycle [N].
  double force_peak = 0;
  /// Maximum digging resistance during the cycle (BucketLoad::draft) [N].
  double draft_peak = 0;
  /// Maximum upward soil force after the start of the curl (BucketLoad::uplift) [N]. It occurs when
  /// the heel or the floor of the bucket presses on the ground.
  double uplift_peak = 0;
  /// Place (x, y) of the machine's base link in W at the start [m]. It is reported and decides
  /// nothing.
  Vec2 place = Vec2::Zero();

  /// Saves or loads all fields.
  void visit(Archive& a);
};

/// One tipping of a machine's bed.
struct BedTip {
  /// Index of the machine in scene::Scene::machines.
  int machine = 0;
  /// Simulated times at which tipping started and ended [s].
  double start = 0, end = 0;
  /// Mass of the soil in the bed at the times `start` and `end` [kg].
  double payload_start = 0, payload_end = 0;

  /// Saves or loads all fields.
  void visit(Archive& a);
};

/// Statistics of the soil force on tools over all steps in which the tools touch soil. Forces on
/// beds are excluded from `peak`, `sum` and `steps`, because the soil in a bed is a load.
struct ForceStatistics {
  /// Maximum magnitude of the low-pass filtered force on any tool [N].
  double peak = 0;
  /// Maximum digging resistance of any bucket (BucketLoad::draft) [N].
  double draft_peak = 0;
  /// Sum of the magnitudes of the unfiltered force over `steps` [N].
  double sum = 0;
  /// Number of steps in contact, summed over all tools.
  std::uint64_t steps = 0;
  /// Maximum magnitude of the low-pass filtered force of rock on any tool [N].
  double rock_peak = 0;
  /// Maximum relative error of the momentum balance between a tool and the soil [-]: the largest
  /// component of the residual, divided by the scale of the exchanged momentum.
  double residual_max = 0;
  /// Returns the mean force on a tool in contact [N]; 0 if there was no contact.
  double mean() const { return steps > 0 ? sum / static_cast<double>(steps) : 0; }

  /// Saves or loads all fields.
  void visit(Archive& a);
};

/// Current state or final outcome of the program of one machine.
struct ProgramReport {
  /// Index of the machine in scene::Scene::machines.
  int machine = 0;
  /// Number of steps of the program; 0 for a machine without a program.
  int steps = 0;
  /// True if inputs have taken over the machine from its program.
  bool taken = false;
  /// Reports of the completed steps, first those of programs that orders replaced, and of the step
  /// that runs, if any. The state of the last entry is the state of the program. Never empty.
  std::vector<control::StepReport> list;
  /// Planned paths, in the order in which they were planned.
  std::vector<control::PlannedPath> paths;
  /// Number of programs that were ordered so far (Session::order). The last one is the program.
  int orders = 0;

  /// Returns the last entry of `list`: the running step, or the step with which the program ended.
  const control::StepReport& last() const { return list.back(); }
  /// Returns true if the machine tipped over or was buried while no program controlled it. The last
  /// entry of `list` then has step number 0 and describes the fall.
  bool fell() const { return last().step == 0; }
  /// Returns true if inputs have taken over the machine and it has not fallen. Its program has no
  /// outcome then.
  bool by_inputs() const { return taken && !fell(); }
};

/// Returns a report as one line of text, such as "'truck', step 1 of 3 (drive_to): blocked: ...
/// (12.30 s, at 3.20, 4.50 m)". `name` is the name of the machine in the scene. If the run has
/// ended during a step, `cut` states the reason; it is empty otherwise.
std::string report_line(const ProgramReport& report, const std::string& name,
                        const std::string& cut = "");

}  // namespace navvy::session
