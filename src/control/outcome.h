// SPDX-License-Identifier: Apache-2.0
// How steps and programs end: states, reasons, measurements. A run's summary reports them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/archive.h"
#include "core/math.h"

namespace navvy::control {

/// State of a step. All values after kDone fell short of their aim and end their program.
enum class StepState : std::uint8_t {
  kRunning,
  kDone,
  /// Something holds the machine, or what it waits for cannot happen any more.
  kBlocked,
  /// It works without progress: wheels spin, scoops bring nothing.
  kStalled,
  /// The machine rolled or pitched over.
  kTipped,
  /// The target cannot be reached from where the machine stands.
  kOutOfReach,
  /// The step's time limit or the run's duration was over first.
  kOutOfTime,
  /// The machine has sunk into the ground, or soil covers it.
  kBuried,
  /// No path leads to the target.
  kNoPath,
};

/// Returns the name in files and messages, such as "out_of_reach".
const char* name_of(StepState state);
/// Returns true when the step ended without reaching its aim.
inline bool fell_short(StepState state) { return state > StepState::kDone; }

/// A named measurement of a step's account.
struct Measurement {
  /// Name that ends in its unit, as keys of summary.json do: "depth_reached_m".
  std::string name;  ///< ends in its unit, as keys of summary.json do: "depth_reached_m"
  double value = 0;

  void visit(Archive& a);
};

/// Result of one step of a program.
struct StepReport {
  /// Number in the program, 1-based.
  std::int64_t step = 0;
  /// Element in scene files: "drive_to".
  std::string element;  ///< as scene files call it: "drive_to"
  StepState state = StepState::kRunning;
  /// A sentence; empty when the step is done and there is nothing to say.
  std::string reason;
  /// Simulated start and end [s]; the end is the present time while the step runs.
  double start = 0, end = 0;
  /// Position of the base link at the end [m] in W.
  Vec3 place = Vec3::Zero();
  /// The step's own measurements (Activity::account).
  std::vector<Measurement> figures;

  void visit(Archive& a);
};

}  // namespace navvy::control
