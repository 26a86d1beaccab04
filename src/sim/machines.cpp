// SPDX-License-Identifier: Apache-2.0
#include "sim/machines.h"

#include "core/error.h"
#include "sim/names.h"
#include "sim/world_parts.h"

namespace navvy::sim {

int Machines::count() const { return static_cast<int>(parts_->description.machines.size()); }

MachineHandle Machines::at(const std::string& name) const {
  return at(
      index_of("machine", parts_->description.machines, name,
               [](const scene::MachineInWorld& one) -> const std::string& { return one.name; }));
}

// Checked here, so that reading through a handle needs no check.
MachineHandle Machines::at(int index) const {
  require_index("machine", index, parts_->description.machines.size());
  MachineHandle out;
  out.parts_ = parts_;
  out.machine_ = index;
  return out;
}

std::vector<ToolHandle> Machines::tools() const {
  std::vector<ToolHandle> out(parts_->coupling.tools().size());
  for (std::size_t t = 0; t < out.size(); ++t) {
    out[t].parts_ = parts_;
    out[t].tool_ = static_cast<int>(t);
  }
  return out;
}

vehicle::HitchState Machines::hitch(int index) const {
  require_hitch(parts_->description, index);
  return parts_->dynamic->hitches()->hitch(index);
}

}  // namespace navvy::sim
