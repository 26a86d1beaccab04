// SPDX-License-Identifier: Apache-2.0
// How steps and programs end: states, reasons, figures. What a summary tells of a run's programs
// comes from here.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/archive.h"
#include "core/math.h"

namespace navvy::control {

/// How a step stands or ended. All after kDone fell short of their aim, and end their program.
enum class StepState : std::uint8_t {
  kRunning,
  kDone,
  kBlocked,     ///< something holds the machine, or what it waits for cannot come any more
  kStalled,     ///< it works and gets nowhere: wheels that spin, scoops that bring nothing
  kTipped,      ///< the machine rolled or pitched over
  kOutOfReach,  ///< the target cannot be reached from where the machine stands
  kOutOfTime,   ///< its patience, or the run's duration, was over first
  kBuried,      ///< the machine has sunk into the ground, or lies under soil
  kNoPath,      ///< there is no way to where it shall go
};

/// As files and messages call it: "out_of_reach".
const char* name_of(StepState state);
/// Whether it ended without reaching its aim.
inline bool fell_short(StepState state) { return state > StepState::kDone; }

/// A figure of a step's account: what it came to as a number.
struct Measurement {
  std::string name;  ///< ends in its unit, as keys of summary.json do: "depth_reached_m"
  double value = 0;

  void visit(Archive& a);
};

/// What became of one step of a program.
struct StepReport {
  std::int64_t step = 0;  ///< its number in the program, the first is 1
  std::string element;    ///< as scene files call it: "drive_to"
  StepState state = StepState::kRunning;
  std::string reason;         ///< a sentence; empty when it is done and there is nothing to say
  double start = 0, end = 0;  ///< [s] simulated; end is the present while it runs
  Vec3 place = Vec3::Zero();  ///< of the base link then [m] in W
  std::vector<Measurement> figures;  ///< the step's own account (Activity::account)

  void visit(Archive& a);
};

}  // namespace navvy::control
