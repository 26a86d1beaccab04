// SPDX-License-Identifier: Apache-2.0
#include "sim/machines.h"

#include <utility>

#include "core/error.h"
#include "sim/names.h"
#include "sim/world_parts.h"
#include "vehicle/body_contact.h"

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

void LinkPair::visit_links(Archive& a) {
  a("machine", machine);
  a("link", link);
  a("other_machine", other_machine);
  a("other_link", other_link);
}

std::vector<MachineContact> Machines::contacts() const {
  std::vector<MachineContact> out;
  const auto* capability = dynamic_cast<const vehicle::ContactCapability*>(parts_->dynamic.get());
  if (capability == nullptr) return out;
  const auto& machines = parts_->description.machines;
  // Obstacles are the kinematic machines, in the scene's order, as are those of the other engine.
  const auto index_of_body = [&](const vehicle::ContactBody& body) {
    int before = 0;
    for (std::size_t m = 0; m < machines.size(); ++m)
      if (machines[m].machine.kinematic == body.obstacle && before++ == body.machine)
        return static_cast<int>(m);
    return -1;
  };
  for (const vehicle::BodyContact& contact : capability->body_contacts()) {
    MachineContact one{{index_of_body(contact.one), contact.one.link, index_of_body(contact.other),
                        contact.other.link},
                       contact.force,
                       contact.depth,
                       contact.size};
    // -1 is a body that is no machine of the scene; contacts inside a machine are left out as well.
    if (one.machine < 0 || one.other_machine < 0 || one.machine == one.other_machine) continue;
    // The lower index comes first, so that a pair has one form whatever the engine's order.
    if (one.machine > one.other_machine) {
      std::swap(one.machine, one.other_machine);
      std::swap(one.link, one.other_link);
    }
    out.push_back(one);
  }
  return out;
}

}  // namespace navvy::sim
