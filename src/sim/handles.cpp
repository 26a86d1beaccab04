// SPDX-License-Identifier: Apache-2.0
#include "sim/handles.h"

#include <optional>
#include <utility>

#include "core/error.h"
#include "sim/names.h"
#include "sim/world_parts.h"

namespace navvy::sim {
namespace {

/// Returns entry `index` of a list in a machine's file. Every handle uses it, so every index is
/// checked.
template <class Entry>
const Entry* entry(const std::string& kind, const std::vector<Entry>& list, int index) {
  require_index(kind, index, list.size());
  return &list[static_cast<std::size_t>(index)];
}

// Links, joints and shells are looked up by name in the same way.
const auto kName = [](const auto& part) -> const std::string& { return part.name; };

}  // namespace

// Each read asks the engine: nothing is cached that a step or a loaded snapshot could change.
const std::string& LinkHandle::name() const { return link_->name; }
Pose LinkHandle::pose() const { return state().X_WL; }
// Velocity of the link's origin; another point adds w x r.
Vec3 LinkHandle::velocity() const { return state().v_WL; }
Vec3 LinkHandle::angular_velocity() const { return state().w_WL; }
// Engines return values without allocating memory.
vehicle::LinkState LinkHandle::state() const { return engine_->link(body_, index_); }

// The engine computes a joint's state on each call: to read several of its values, call state()
// once.
const std::string& JointHandle::name() const { return joint_->name; }
// One number each, at the cost of state().
double JointHandle::position() const { return state().position; }
double JointHandle::velocity() const { return state().velocity; }
double JointHandle::effort() const { return state().effort; }
std::uint64_t JointHandle::counts() const {
  if (encoder_ != nullptr) return encoder_->counts();
  throw InputError(Fault{Fault::Severity::kError, "", 0, "joint", name(), "has no encoder",
                         "add <navvy:encoder> to the machine's model"});
}
vehicle::JointState JointHandle::state() const { return engine_->joint(body_, index_); }

// A wheel has no name of its own; telemetry shows its spin joint's, too.
const std::string& WheelHandle::name() const { return wheel_->joint; }
vehicle::WheelState WheelHandle::state() const { return engine_->wheel(body_, index_); }

namespace {

// The list of tools never changes after construction, so an index into it stays valid.
const coupling::ToolLoad& load(const WorldParts& parts, int tool) {
  return parts.coupling.tools()[static_cast<std::size_t>(tool)];
}
// The machine's data says what a tool is for; the coupling does not distinguish buckets from
// blades.
const scene::Machine& machine_of(const WorldParts& parts, const coupling::ToolLoad& tool) {
  return parts.description.machines[static_cast<std::size_t>(tool.machine)].machine;
}

}  // namespace

const std::string& ToolHandle::name() const {
  const coupling::ToolLoad& tool = load(*parts_, tool_);
  return machine_of(*parts_, tool).shells[static_cast<std::size_t>(tool.shell)].name;
}
int ToolHandle::machine() const { return load(*parts_, tool_).machine; }
bool ToolHandle::is_bucket() const {
  const coupling::ToolLoad& tool = load(*parts_, tool_);
  return machine_of(*parts_, tool).is_bucket(tool.shell);
}
bool ToolHandle::is_bed() const {
  const coupling::ToolLoad& tool = load(*parts_, tool_);
  return machine_of(*parts_, tool).is_bed(tool.shell);
}
// The coupling stores these after each step; only the payload is computed on demand.
Vec3 ToolHandle::force() const { return load(*parts_, tool_).force_W; }
Vec3 ToolHandle::edge_force() const { return load(*parts_, tool_).edge_force_W; }
Vec3 ToolHandle::moment() const { return load(*parts_, tool_).moment_W; }
Vec3 ToolHandle::smooth_force() const { return load(*parts_, tool_).smooth_W; }
Vec3 ToolHandle::rock_force() const { return load(*parts_, tool_).rock_W; }
// The coupling knows the other tools: soil in a bucket inside a bed counts for the bucket.
// It is computed once a step: operators, gauges and outputs read the same value.
double ToolHandle::payload() const {
  const coupling::ToolLoad& tool = load(*parts_, tool_);
  std::optional<double>& out = parts_->payloads[static_cast<std::size_t>(tool_)];
  if (!out) out = parts_->coupling.payload(tool);
  return *out;
}
// Copied into sim's own type, so that no client sees the solver's.
MomentumBalance ToolHandle::momentum_balance() const {
  const soil::ToolImpulse& impulse = load(*parts_, tool_).impulse;
  return {impulse.residual, impulse.residual_moment, impulse.scale, impulse.scale_moment};
}

const std::string& MachineHandle::name() const {
  return parts_->description.machines[static_cast<std::size_t>(machine_)].name;
}
const scene::Machine& MachineHandle::description() const {
  return parts_->description.machines[static_cast<std::size_t>(machine_)].machine;
}

// Resolve names to indices, check the indices, and store what is needed to read without a look-up.
LinkHandle MachineHandle::link(const std::string& name) const {
  return link(index_of("link", description().links, name, kName));
}
LinkHandle MachineHandle::link(int index) const {
  LinkHandle out;
  out.link_ = entry("link", description().links, index);
  // The machine's engine and its index there, which may differ from the world's.
  out.engine_ = &parts_->coupling.engine(machine_);
  out.body_ = parts_->coupling.index(machine_);
  out.index_ = index;
  return out;
}

JointHandle MachineHandle::joint(const std::string& name) const {
  return joint(index_of("joint", description().joints, name, kName));
}
// A joint also stores its machine of the world, for commands.
JointHandle MachineHandle::joint(int index) const {
  JointHandle out;
  out.joint_ = entry("joint", description().joints, index);
  out.engine_ = &parts_->coupling.engine(machine_);
  out.encoder_ = parts_->encoders[static_cast<std::size_t>(machine_)].of_joint(index);
  out.machine_ = machine_;
  out.body_ = parts_->coupling.index(machine_);
  out.index_ = index;
  return out;
}

// Wheels by the name of their spin joint.
WheelHandle MachineHandle::wheel(const std::string& name) const {
  return wheel(
      index_of("wheel", description().wheels, name,
               [](const scene::Wheel& wheel) -> const std::string& { return wheel.joint; }));
}
WheelHandle MachineHandle::wheel(int index) const {
  WheelHandle out;
  out.wheel_ = entry("wheel", description().wheels, index);
  out.engine_ = &parts_->coupling.engine(machine_);
  out.body_ = parts_->coupling.index(machine_);
  out.index_ = index;
  return out;
}

// Shells of a machine are its tools, named by the shell.
ToolHandle MachineHandle::tool(const std::string& name) const {
  return tool(index_of("tool", description().shells, name, kName));
}
ToolHandle MachineHandle::tool(int index) const {
  require_index("tool", index, description().shells.size());
  const std::vector<coupling::ToolLoad>& tools = parts_->coupling.tools();
  ToolHandle out;
  out.parts_ = parts_;
  // Every shell is a tool, so this finds one.
  while (out.tool_ + 1 < static_cast<int>(tools.size())) {
    const coupling::ToolLoad& tool = load(*parts_, ++out.tool_);
    if (tool.machine == machine_ && tool.shell == index) break;
  }
  return out;
}

// Engines without a capability report zeros.
vehicle::PumpState MachineHandle::pump() const {
  const vehicle::PowerCapability* power = parts_->coupling.engine(machine_).power();
  return power ? power->pump(parts_->coupling.index(machine_)) : vehicle::PumpState();
}
vehicle::CombustionEngineState MachineHandle::engine() const {
  const vehicle::PowerCapability* power = parts_->coupling.engine(machine_).power();
  return power ? power->drive_engine(parts_->coupling.index(machine_))
               : vehicle::CombustionEngineState();
}
vehicle::DriveInput MachineHandle::drive() const {
  return parts_->coupling.engine(machine_).drive(parts_->coupling.index(machine_));
}
vehicle::BaseInput MachineHandle::base() const {
  return vehicle::base_target(parts_->coupling.engine(machine_), parts_->coupling.index(machine_));
}
// Computed once a step, too.
vehicle::Stability MachineHandle::stability() const {
  std::optional<vehicle::Stability>& out = parts_->stabilities[static_cast<std::size_t>(machine_)];
  if (!out)
    out = vehicle::stability(description(), parts_->coupling.engine(machine_),
                             parts_->coupling.index(machine_));
  return *out;
}
double MachineHandle::work() const {
  const vehicle::AccountCapability* accounts = parts_->coupling.engine(machine_).accounts();
  return accounts ? accounts->work(parts_->coupling.index(machine_)) : 0;
}

}  // namespace navvy::sim
