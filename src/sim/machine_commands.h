// SPDX-License-Identifier: Apache-2.0
// Commands to the machines of a world.
#pragma once

#include "sim/handles.h"
#include "vehicle/machine_state.h"

namespace navvy::sim {

/// Commands the machines of a world: joints, drives, bases, brakes and hitches. A command remains
/// in effect until another one replaces it.
///
/// An object of this class is a pointer to its world: it is cheap to copy and valid as long as the
/// world exists. Every function throws InputError for a handle of another world or a value that is
/// not finite; the world is then unchanged.
class MachineCommands {
 public:
  /// Maximum absolute value of each coordinate of a commanded base position [m].
  static constexpr double kFarthest = 1e6;

  /// Creates commands for the world that owns `parts`. Clients call World::commands instead.
  explicit MachineCommands(WorldParts& parts) : parts_(&parts) {}

  /// Commands a joint. If the machine's drive moves the joint as well, the joint follows the drive
  /// again as soon as the drive receives its next command.
  void set(const JointHandle& joint, const vehicle::JointInput& input);
  /// Commands the drive of a machine: speed, steering, brake and gear. Has no effect on a machine
  /// without a drive.
  void set(const MachineHandle& machine, const vehicle::DriveInput& input);
  /// Commands a kinematic machine's base link to move to a target pose.
  /// @throws InputError for a dynamic machine or a fixed base.
  void set(const MachineHandle& machine, const vehicle::BaseInput& input);
  /// Sets (`on` is true) or releases the brake of a joint. While the brake is set, the joint does
  /// not follow commands.
  /// @throws InputError for a joint without a brake.
  void set_brake(const JointHandle& joint, bool on);
  /// Sets the force on a link of `machine`, in axes of W [N]. It acts in every step until it is set
  /// again. `link` is an index into scene::Machine::links.
  /// @throws InputError for a link without a force input.
  void set_force(const MachineHandle& machine, int link, const Vec3& f_W);
  /// Closes (`closed` is true) or opens a hitch. `hitch` is an index into scene::Scene::hitches.
  /// @throws InputError for a hitch that does not exist, or if the eye is too far from the hook to
  /// close.
  void set_hitch(int hitch, bool closed);

  /// Checks a joint command without changing anything. A joint that follows another one by a gear
  /// takes no commands.
  /// @throws InputError if `set` would throw for these arguments.
  void require_valid(const JointHandle& joint, const vehicle::JointInput& input) const;
  /// Checks a drive command without changing anything.
  /// @throws InputError if `set` would throw for these arguments.
  void require_valid(const MachineHandle& machine, const vehicle::DriveInput& input) const;
  /// Checks a base command without changing anything.
  /// @throws InputError if `set` would throw for these arguments.
  void require_valid(const MachineHandle& machine, const vehicle::BaseInput& input) const;
  /// Checks that a joint has a brake, without changing anything.
  /// @throws InputError if `set_brake` would throw for this joint.
  void require_brake(const JointHandle& joint) const;

 private:
  WorldParts* parts_;
};

}  // namespace navvy::sim
