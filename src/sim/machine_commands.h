// SPDX-License-Identifier: Apache-2.0
// Commands to the machines of a world.
#pragma once

#include "sim/handles.h"
#include "vehicle/machine_state.h"

namespace navvy::sim {

/// Drives the machines of a world. Every command holds until it is replaced.
///
/// A view of one pointer: copy it freely. Valid as long as its world lives. Every function throws
/// InputError for a handle of another world or a value that is not finite, and then changes
/// nothing.
class MachineCommands {
 public:
  /// Largest distance of a base from the origin along any axis [m].
  static constexpr double kFarthest = 1e6;

  /// Refers to the parts of a world; World::commands makes it.
  explicit MachineCommands(WorldParts& parts) : parts_(&parts) {}

  /// Commands a joint. A joint that a drive also moves returns to the drive with the drive's
  /// next command.
  void set(const JointHandle& joint, const vehicle::JointInput& input);
  /// Commands a drive. Has no effect on a machine without one.
  void set(const MachineHandle& machine, const vehicle::DriveInput& input);
  /// Moves the base of a kinematic machine. @throws InputError also for a dynamic machine.
  void set(const MachineHandle& machine, const vehicle::BaseInput& input);
  /// Sets or releases a joint's brake; while it is set, the joint does not follow its command.
  /// @throws InputError for a joint without a brake.
  void set_brake(const JointHandle& joint, bool on);
  /// Opens or closes a hitch of the scene, by its index there.
  /// @throws InputError for a hitch that does not exist, and for an eye out of the hook's reach.
  void set_hitch(int hitch, bool closed);

  /// Throws what `set` would throw, and changes nothing.
  void require_valid(const JointHandle& joint, const vehicle::JointInput& input) const;
  void require_valid(const MachineHandle& machine, const vehicle::DriveInput& input) const;
  void require_valid(const MachineHandle& machine, const vehicle::BaseInput& input) const;
  /// Throws what `set_brake` would throw.
  void require_brake(const JointHandle& joint) const;

 private:
  WorldParts* parts_;
};

}  // namespace navvy::sim
