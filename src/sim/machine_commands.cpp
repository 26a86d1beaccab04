// SPDX-License-Identifier: Apache-2.0
#include "sim/machine_commands.h"

#include <cmath>

#include "core/error.h"
#include "sim/world_parts.h"

namespace navvy::sim {
namespace {

// Clients also send commands as lines of text: what an engine cannot use stops here.
void require_machine(int machine, const scene::Scene& scene) {
  if (machine >= 0 && machine < static_cast<int>(scene.machines.size())) return;
  throw InputError(Fault{Fault::Severity::kError, "", 0, "command", std::to_string(machine),
                         "the handle belongs to no machine of this world",
                         "take handles from the same world"});
}
void require_finite(const std::string& what, double value) {
  if (std::isfinite(value)) return;
  throw InputError(Fault{Fault::Severity::kError, "", 0, what, std::to_string(value),
                         "must be a finite number", "send a number"});
}

}  // namespace

// A handle of another world may have indices that do not exist here.
void MachineCommands::require_valid(const JointHandle& joint,
                                    const vehicle::JointInput& input) const {
  require_machine(joint.machine(), parts_->description);
  const auto& joints =
      parts_->description.machines[static_cast<std::size_t>(joint.machine())].machine.joints;
  if (joint.index() < 0 || joint.index() >= static_cast<int>(joints.size()))
    throw InputError(Fault{Fault::Severity::kError, "", 0, "command", std::to_string(joint.index()),
                           "the handle belongs to no joint of this machine",
                           "take handles from the same world"});
  for (const scene::JointGear& gear :
       parts_->description.machines[static_cast<std::size_t>(joint.machine())].machine.gears)
    if (gear.follower == joint.index() && input.mode != vehicle::JointMode::kFree)
      throw InputError(Fault{Fault::Severity::kError, "", 0, "command", joint.name(),
                             "this joint follows joint '" +
                                 joints[static_cast<std::size_t>(gear.leader)].name +
                                 "' by a fixed ratio",
                             "command that joint"});
  require_finite("command of joint '" + joints[static_cast<std::size_t>(joint.index())].name + "'",
                 input.target);
}

// Gears exist only for drives with a combustion engine.
void MachineCommands::require_valid(const MachineHandle& machine,
                                    const vehicle::DriveInput& input) const {
  require_machine(machine.index(), parts_->description);
  require_finite("speed of the drive", input.speed);
  require_finite("steering of the drive", input.steer);
  const scene::CombustionEngine* engine = scene::drive_engine(machine.description().drive);
  const int gears = engine == nullptr ? 0 : static_cast<int>(engine->gears.size());
  if (input.gear < 0 || input.gear > gears)
    throw InputError(Fault{
        Fault::Severity::kError, "", 0, "gear of " + machine.name(), std::to_string(input.gear),
        gears == 0 ? "its drive has no gears" : "its gears are 1 to " + std::to_string(gears),
        "give one of them, or 0 for automatic"});
}

// Angles may exceed a turn; a position must be one that a site can have.
void MachineCommands::require_valid(const MachineHandle& machine,
                                    const vehicle::BaseInput& input) const {
  require_machine(machine.index(), parts_->description);
  for (int i = 0; i < 3; ++i) {
    require_finite("position of the base", input.p_W[i]);
    require_finite("angle of the base", input.angles[i]);
    if (std::abs(input.p_W[i]) > kFarthest)
      throw InputError(Fault{
          Fault::Severity::kError, "", 0, "position of the base", std::to_string(input.p_W[i]),
          "a site is at most 1000 km from the origin", "give a position in metres in W"});
  }
  if (!(input.duration >= 0) || !std::isfinite(input.duration))
    throw InputError(Fault{Fault::Severity::kError, "", 0, "duration of the base's motion",
                           std::to_string(input.duration), "must be 0 or more seconds",
                           "give 0 to move within one step"});
  const scene::Machine& built = machine.description();
  if (!built.kinematic || built.fixed_base)
    throw InputError(
        Fault{Fault::Severity::kError, "", 0, "command", machine.name(),
              built.kinematic ? "its base is fixed" : "forces move this machine",
              "set <navvy:physics>kinematic</navvy:physics>, and leave its base free"});
}

// Joints without a brake would ignore the command, so report it.
void MachineCommands::require_brake(const JointHandle& joint) const {
  require_valid(joint, vehicle::JointInput{vehicle::JointMode::kFree, 0});
  const scene::Machine& machine =
      parts_->description.machines[static_cast<std::size_t>(joint.machine())].machine;
  if (!(machine.joints[static_cast<std::size_t>(joint.index())].brake > 0))
    throw InputError(Fault{Fault::Severity::kError, "", 0, "brake", joint.name(),
                           "this joint has no brake",
                           "give it <navvy:brake> in the machine's file"});
}

// Both engines number their machines on their own: the coupling maps a machine of the scene to its
// engine and its index there.
void MachineCommands::set(const JointHandle& joint, const vehicle::JointInput& input) {
  require_valid(joint, input);
  const int m = joint.machine();
  parts_->coupling.engine(m).set_joint(parts_->coupling.index(m), joint.index(), input);
}
void MachineCommands::set(const MachineHandle& machine, const vehicle::DriveInput& input) {
  require_valid(machine, input);
  const int m = machine.index();
  parts_->coupling.engine(m).set_drive(parts_->coupling.index(m), input);
}
void MachineCommands::set(const MachineHandle& machine, const vehicle::BaseInput& input) {
  require_valid(machine, input);
  const int m = machine.index();
  const int index = parts_->coupling.index(m);
  vehicle::require_placement(parts_->coupling.engine(m), index).set_base(index, input);
}
void MachineCommands::set_brake(const JointHandle& joint, bool on) {
  require_brake(joint);
  const int m = joint.machine();
  parts_->coupling.engine(m).set_brake(parts_->coupling.index(m), joint.index(), on);
}
void MachineCommands::set_force(const MachineHandle& machine, int link, const Vec3& f_W) {
  require_machine(machine.index(), parts_->description);
  for (int i = 0; i < 3; ++i) require_finite("force on a link", f_W[i]);
  const int force = parts_->forces.find(machine.index(), link);
  if (force < 0)
    throw InputError(Fault{Fault::Severity::kError, "", 0, "force", std::to_string(link),
                           "this link has no force input",
                           "give it <navvy:force_input/> in the machine's file"});
  parts_->forces.set(force, f_W);
}
void MachineCommands::set_hitch(int hitch, bool closed) {
  require_hitch(parts_->description, hitch);
  // Coupling refuses scenes with hitches on an engine without them, so the capability is there.
  parts_->dynamic->hitches()->set_hitch(hitch, closed);
}

}  // namespace navvy::sim
