// SPDX-License-Identifier: Apache-2.0
// Access to the machines of a world, for reading.
#pragma once

#include <string>
#include <vector>

#include "sim/handles.h"
#include "sim/machine_contact.h"
#include "vehicle/machine_state.h"

namespace navvy::sim {

/// Gives access to the machines of a world, in the order of World::description().machines. Only for
/// reading; sim::MachineCommands sends commands.
///
/// An object of this class is a pointer to its world: it is cheap to copy and valid as long as the
/// world exists.
class Machines {
 public:
  /// Creates access to the machines of the world that owns `parts`. Clients call World::machines
  /// instead.
  explicit Machines(const WorldParts& parts) : parts_(&parts) {}

  /// Returns the number of machines; 0 for a scene that contains only soil.
  int count() const;
  /// Returns a handle to the machine with this name.
  /// @throws InputError if there is none; the message names the most similar one.
  MachineHandle at(const std::string& name) const;
  /// Returns a handle to the machine with this index, counted from 0.
  /// @throws InputError if there is none; the message gives the number of machines.
  MachineHandle at(int index) const;
  /// Returns handles to the tools (shells) of all machines, machine by machine.
  std::vector<ToolHandle> tools() const;
  /// Returns the current state of a hitch. `index` is an index into scene::Scene::hitches.
  /// @throws InputError for a hitch that does not exist.
  vehicle::HitchState hitch(int index) const;
  /// Returns the contacts between machines in the last step; those of two bodies of one link that
  /// forces move are among them only if they are deep (vehicle::ContactCapability). Empty if the
  /// physics engine does not report any.
  std::vector<MachineContact> contacts() const;

 private:
  const WorldParts* parts_;
};

}  // namespace navvy::sim
