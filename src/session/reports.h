// SPDX-License-Identifier: Apache-2.0
// What the programs of a run came to: cycles, tips, forces, and how each ended.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "control/outcome.h"
#include "control/path.h"
#include "core/archive.h"

namespace navvy::session {

/// One scoop-swing-dump cycle of a machine; times [s] simulated, masses [kg] in the bucket. Opened
/// by the first touch of a scoop, closed when the bucket is empty; payloads as they were at those
/// moments.
struct Cycle {
  int machine = 0;  ///< as in scene::Scene::machines
  double start = 0, curl = 0, lift_out = 0, dump_start = 0, end = 0;
  double payload_lift_out = 0, payload_dump = 0;
  double force_peak = 0;  ///< largest low-passed soil force on the bucket [N]
  double draft_peak = 0;  ///< largest of it against the lip's motion: what digging takes [N]
  /// Largest of it upward since the curl began: the heel or back bears on the ground [N].
  double uplift_peak = 0;

  void visit(Archive& a);
};

/// One tip of a machine's bed; times [s] simulated, masses [kg].
struct BedTip {
  int machine = 0;
  double start = 0, end = 0;
  double payload_start = 0, payload_end = 0;  ///< in the bed

  void visit(Archive& a);
};

/// Soil force on buckets over all steps in contact.
/// Beds do not count: what lies in them is a load.
struct ForceStatistics {
  double peak = 0;        ///< of the low-passed force [N]
  double draft_peak = 0;  ///< of its part against the motion of a bucket's lip [N]
  double sum = 0;         ///< of |force| x steps in contact
  std::uint64_t steps = 0;
  double rock_peak = 0;     ///< of rock on any shell, low-passed [N]
  double residual_max = 0;  ///< largest |momentum residual| / scale of a nodal solve
  double mean() const { return steps > 0 ? sum / static_cast<double>(steps) : 0; }

  void visit(Archive& a);
};

/// How the program of one machine stands, or ended.
struct ProgramReport {
  int machine = 0;     ///< as in scene::Scene::machines
  int steps = 0;       ///< of the program
  bool taken = false;  ///< by inputs, which drive the machine since then
  /// Of every step that is over, and of the one that runs: its state is that of the program.
  std::vector<control::StepReport> list;
  /// Every path planned so far, in the order in which they were.
  std::vector<control::PlannedPath> paths;

  /// The step that the program is at, or ended with.
  const control::StepReport& last() const { return list.back(); }
  /// The machine fell over by itself, or while inputs drove it: the last entry, of step 0, says so.
  bool fell() const { return last().step == 0; }
  /// Inputs drive it and all is well: what became of the step that it was taken from nobody knows.
  bool by_inputs() const { return taken && !fell(); }
};

/// "'truck', step 1 of 3 (drive_to): blocked: ... (12.30 s, at 3.20, 4.50)": one line for people.
/// `name` is the machine's in the scene. `cut`: why a step that still ran has ended, where the run
/// is over.
std::string told(const ProgramReport& report, const std::string& name, const std::string& cut = "");

}  // namespace navvy::session
