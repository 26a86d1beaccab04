// SPDX-License-Identifier: Apache-2.0
// What goes into an operator and what comes out of it, once a control step.
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

/// How far a machine's program has come.
struct ProgramProgress {
  int done = 0, steps = 0;  ///< steps that are over, and all
  bool failed = false;      ///< a step fell short: no other will be done
};

/// What the operator knows at one control step: what can be seen and felt from a cab.
struct Observation {
  std::vector<vehicle::JointState> joints;  ///< as in scene::Machine::joints
  Pose X_WB = Pose::Identity();             ///< base link
  Vec3 v_WB = Vec3::Zero();                 ///< [m/s]
  const heightfield::Ground* ground = nullptr;
  /// The ground with loose soil on it; null: the resting ground alone.
  const SurfaceView* surface = nullptr;
  double payload = 0;              ///< soil in the bucket [kg]
  double force = 0;                ///< low-passed soil force on the bucket [N]
  vehicle::Stability stability;    ///< how the machine stands
  Vec3 tyre_force = Vec3::Zero();  ///< of all wheels together, by the ground [N] in W
  /// Share of the wheels whose tops lie below the resting ground.
  double wheels_under = 0;
  /// Of all machines of the world, by name.
  const std::map<std::string, ProgramProgress>* programs = nullptr;
};

/// What it wants; joints without an entry keep their last command.
struct Command {
  std::vector<std::optional<vehicle::JointInput>> joints;  ///< as in scene::Machine::joints
  std::optional<vehicle::DriveInput> drive;                ///< without: as last commanded
  std::optional<std::string> unhitch;                      ///< the hitch of this name is let go
};

/// Moments of a digging cycle and of a tip, told once each.
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
