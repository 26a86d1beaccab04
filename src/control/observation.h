// SPDX-License-Identifier: Apache-2.0
// Inputs and outputs of an operator in one control step.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "control/surface.h"
#include "core/math.h"
#include "heightfield/layered_ground.h"
#include "vehicle/machine_state.h"

namespace navvy::control {

/// Progress of a machine's program.
struct ProgramProgress {
  /// Steps that are over, and all steps.
  int done = 0, steps = 0;
  /// True when a step fell short: no further step will run.
  bool failed = false;
};

/// Everything that the operator knows in one control step: what can be seen and felt from a cab.
struct Observation {
  /// States of the joints, in the order of scene::Machine::joints.
  std::vector<vehicle::JointState> joints;
  /// Pose of the base link.
  Pose X_WB = Pose::Identity();
  /// Velocity of the base link [m/s].
  Vec3 v_WB = Vec3::Zero();
  const heightfield::Ground* ground = nullptr;
  /// The ground with loose soil on it; null: only the resting ground is known.
  const SurfaceView* surface = nullptr;
  /// Mass of the soil in the bucket [kg].
  double payload = 0;
  /// Magnitude of the low-pass filtered soil force on the bucket [N].
  double force = 0;
  /// Stability of the machine.
  vehicle::Stability stability;
  /// Force of the ground on all wheels together [N] in W.
  Vec3 tyre_force = Vec3::Zero();
  /// Share of the wheels whose tops are below the resting ground.
  double wheels_under = 0;
  /// Progress of all machines of the world, by name.
  const std::map<std::string, ProgramProgress>* programs = nullptr;
};

/// Commands to the machine. Joints without an entry keep their last command.
struct Command {
  /// Joint inputs in the order of scene::Machine::joints.
  std::vector<std::optional<vehicle::JointInput>> joints;
  /// Drive input; without one the last command stays.
  std::optional<vehicle::DriveInput> drive;
  /// Name of the hitch to open.
  std::optional<std::string> unhitch;
};

/// Moments of a digging cycle and of tipping a bed, each reported once.
enum class CycleEvent {
  kNone,
  kScoopStart,
  kCurlStart,
  kLiftOut,
  kDumpStart,
  kCycleEnd,
  kTipStart,
  kTipEnd
};

}  // namespace navvy::control
