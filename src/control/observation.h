// SPDX-License-Identifier: Apache-2.0
// Inputs and outputs of an operator in one control step.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "control/body_view.h"
#include "control/surface.h"
#include "core/math.h"
#include "heightfield/layered_ground.h"
#include "vehicle/machine_state.h"

namespace navvy::control {

/// Progress of the program of one machine.
struct ProgramProgress {
  /// Number of completed steps, and number of all steps.
  int done = 0, steps = 0;
  /// True if a step has failed, so that no further step will run.
  bool failed = false;
};

/// The bed of another machine as it is seen from the cab.
struct BedView {
  /// Middle of the bed in W (x, y), and the vector from there to the middle of its front end, along
  /// its longer side [m].
  Vec2 middle = Vec2::Zero(), to_end = Vec2::Zero();
  /// Height of its highest rim in W [m].
  double rim = 0;
  /// Speed of the machine [m/s].
  double speed = 0;
  /// Mass of the soil in the machine's beds [kg].
  double load = 0;
};

/// Everything that an operator knows in one control step: what it can see and feel in the cab.
struct Observation {
  /// States of the joints, in the order of scene::Machine::joints.
  std::vector<vehicle::JointState> joints;
  /// Pose of the base link in W.
  Pose X_WB = Pose::Identity();
  /// Velocity of the base link in W [m/s].
  Vec3 v_WB = Vec3::Zero();
  /// Resting ground, without loose soil.
  const heightfield::Ground* ground = nullptr;
  /// Surface of the ground with the loose soil on it; null if only the resting ground is known.
  const SurfaceView* surface = nullptr;
  /// Mass of the soil in the bucket [kg].
  double payload = 0;
  /// Magnitude of the low-pass filtered force of the soil on the bucket [N].
  double force = 0;
  /// Static stability of the machine; see vehicle::Stability.
  vehicle::Stability stability;
  /// Total force of the ground on all wheels, in W [N].
  Vec3 tyre_force = Vec3::Zero();
  /// Fraction of the wheels whose tops are below the resting ground [-].
  double wheels_under = 0;
  /// Functions that return the present mass of the soil in the first bucket and in the first bed
  /// [kg]; empty if it is unknown. A call costs a pass over the particles.
  std::function<double()> bucket_load, bed_load;
  /// Function that returns the mass of the soil in the beds of the machine of this name [kg]; empty
  /// if it is unknown. A call costs a pass over the particles.
  std::function<double(const std::string&)> load_of;
  /// Function that returns the first bed of the machine of this name, or nothing if there is none;
  /// empty if it is unknown. A call costs a pass over the particles.
  std::function<std::optional<BedView>(const std::string&)> bed_of;
  /// Function that returns the centre of mass (x, y) of the soil in the first bed of the machine of
  /// this name, in W [m], or nothing without a bed or soil in it; empty if it is unknown. A call
  /// costs a pass over the particles.
  std::function<std::optional<Vec2>(const std::string&)> load_centre_of;
  /// Function that returns all loose bodies in the world, in the order of the scene; empty if they
  /// are unknown.
  std::function<std::vector<BodyView>()> bodies;
  /// Function that returns true if the hitch of this name is closed; empty if that is unknown.
  std::function<bool(const std::string&)> is_hitched;
  /// Function that returns true if another machine is coupled to this one; empty if that is
  /// unknown.
  std::function<bool()> is_coupled;
  /// Progress of the programs in the world, keyed by machine name; null if it is unknown.
  const std::map<std::string, ProgramProgress>* programs = nullptr;
};

/// Commands of an operator to the machine. A joint or drive without a new command continues with
/// the last one.
struct Command {
  /// Commands to the joints, in the order of scene::Machine::joints. Empty entries are joints
  /// without a new command.
  std::vector<std::optional<vehicle::JointInput>> joints;
  /// Command to the drive, or nothing if there is no new command.
  std::optional<vehicle::DriveInput> drive;
  /// Name of the hitch to open, or nothing.
  std::optional<std::string> unhitch;
};

/// Event of a digging cycle or of tipping a bed. Each is reported once, in the control step in
/// which it occurs.
enum class CycleEvent {
  /// No event.
  kNone,
  /// The bucket starts to move down into the ground.
  kScoopStart,
  /// The bucket starts to curl.
  kCurlStart,
  /// The bucket has been lifted out of the ground.
  kLiftOut,
  /// The bucket starts to open over the dump point.
  kDumpStart,
  /// The bucket is empty, and the digging cycle ends.
  kCycleEnd,
  /// The bed starts to move to its target angle.
  kTipStart,
  /// Tipping has ended: the bed has arrived and its holding time is over, or the bed is stuck.
  kTipEnd
};

}  // namespace navvy::control
