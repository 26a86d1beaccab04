// SPDX-License-Identifier: Apache-2.0
// The machines of a world, to read from.
#pragma once

#include <string>
#include <vector>

#include "sim/handles.h"
#include "vehicle/machine_state.h"

namespace navvy::sim {

/// Finds the machines of a world, in the order of World::description().machines.
///
/// A view of one pointer: copy it freely. Valid as long as its world lives. Reads only;
/// sim::MachineCommands drives.
class Machines {
 public:
  /// Refers to the parts of a world; World::machines makes it.
  explicit Machines(const WorldParts& parts) : parts_(&parts) {}

  /// Returns the number of machines; 0 for a scene of soil alone.
  int count() const;
  /// Returns a handle to a machine.
  /// @throws InputError that names the nearest machine, or says how many there are.
  MachineHandle at(const std::string& name) const;
  MachineHandle at(int index) const;
  /// Returns every shell of every machine, machine by machine.
  std::vector<ToolHandle> tools() const;
  /// Returns the state of a hitch, by its index in the scene.
  /// @throws InputError for a hitch that does not exist.
  vehicle::HitchState hitch(int index) const;

 private:
  const WorldParts* parts_;
};

}  // namespace navvy::sim
