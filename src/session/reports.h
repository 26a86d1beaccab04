// SPDX-License-Identifier: Apache-2.0
// Results of the programs of a run: cycles, tips, forces, and how each program ended.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "control/outcome.h"
#include "control/path.h"
#include "core/archive.h"

namespace navvy::session {

/// One dig-swing-dump cycle of a machine. It begins when a scoop first touches the ground and ends
/// when the bucket is empty.
struct Cycle {
  /// Index in scene::Scene::machines.
  int machine = 0;
  /// Simulated times of the first touch, the beginning of the curl, the lift out of the ground, the
  /// beginning of the dump, and the end [s].
  double start = 0, curl = 0, lift_out = 0, dump_start = 0, end = 0;
  /// Mass in the bucket at `lift_out` and at `dump_start` [kg].
  double payload_lift_out = 0, payload_dump = 0;
  /// Maximum of the low-passed soil force on the bucket [N].
  double force_peak = 0;
  /// Maximum of its component against the motion of the cutting edge, the digging resistance [N].
  double draft_peak = 0;
  /// Maximum of its upward component since the curl began, when heel or floor push on the ground
  /// [N].
  double uplift_peak = 0;

  /// Visits every field.
  void visit(Archive& a);
};

/// One tip of a machine's bed.
struct BedTip {
  /// Index in scene::Scene::machines.
  int machine = 0;
  /// Simulated times [s].
  double start = 0, end = 0;
  /// Mass in the bed at those times [kg].
  double payload_start = 0, payload_end = 0;

  /// Visits every field.
  void visit(Archive& a);
};

/// Statistics of the soil force on tools over all steps in contact. Beds do not count, as the soil
/// in them is a load.
struct ForceStatistics {
  /// Maximum of the low-passed force [N].
  double peak = 0;
  /// Maximum of its component against the motion of a bucket's cutting edge [N].
  double draft_peak = 0;
  /// Sum of the force's magnitude over `steps` [N].
  double sum = 0;
  /// Number of steps in contact; each tool in contact counts its own.
  std::uint64_t steps = 0;
  /// Maximum of the low-passed force of rock on any shell [N].
  double rock_peak = 0;
  /// Maximum of |momentum residual| / scale of a nodal solve [-].
  double residual_max = 0;
  /// Returns the mean force in contact [N]; 0 without contact.
  double mean() const { return steps > 0 ? sum / static_cast<double>(steps) : 0; }

  /// Visits every field.
  void visit(Archive& a);
};

/// Status of the program of one machine, or its end.
struct ProgramReport {
  /// Index in scene::Scene::machines.
  int machine = 0;
  /// Number of steps of the program.
  int steps = 0;
  /// True if inputs took the machine from its program.
  bool taken = false;
  /// Reports of the completed steps and of the running one, whose state is that of the program.
  std::vector<control::StepReport> list;
  /// Planned paths, in the order of their planning.
  std::vector<control::PlannedPath> paths;

  /// Returns the report of the running step, or of the one that the program ended with.
  const control::StepReport& last() const { return list.back(); }
  /// Returns true if the machine fell over while no program drove it. The last entry, of step 0,
  /// has the details.
  bool fell() const { return last().step == 0; }
  /// Returns true if inputs drive the machine and it stands. The state of its program is unknown.
  bool by_inputs() const { return taken && !fell(); }
};

/// Returns a report as a line for people: "'truck', step 1 of 3 (drive_to): blocked: ... (12.30 s,
/// at 3.20, 4.50)". `name` is the machine's name in the scene. `cut` says why a running step has
/// ended, if the run is over.
std::string report_line(const ProgramReport& report, const std::string& name,
                        const std::string& cut = "");

}  // namespace navvy::session
