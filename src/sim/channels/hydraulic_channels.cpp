// SPDX-License-Identifier: Apache-2.0
#include "sim/channels/part_channels.h"
#include "sim/world.h"
#include "vehicle/levers.h"

namespace navvy::sim {

// Flow and pressure show which limit of the pump holds a cylinder back.
void add_pump_channels(const MachineChannels& out) {
  const scene::Machine& built = out.machine.description();
  // Kinematic machines take no oil.
  if (!built.has_pump || built.kinematic) return;
  out.outputs.add(
      {out.prefix + "pump/flow", "m3/s", "oil flow into the cylinders in the last step"},
      [machine = out.machine] { return machine.pump().flow; });
  out.outputs.add(
      {out.prefix + "pump/pressure", "Pa", "pressure of the heaviest load that moves, smoothed"},
      [machine = out.machine] { return machine.pump().pressure; });
}

// The pattern of the machine decides which joint a lever moves.
void add_lever_channels(const MachineChannels& out) {
  const scene::Machine& built = out.machine.description();
  if (!built.levers.given) return;
  const vehicle::LeverFunctions functions = vehicle::lever_functions(built);
  for (std::size_t i = 0; i < functions.size(); ++i) {
    // The machine has no joint for this function, for instance no swing.
    if (functions[i].joint < 0) continue;
    const JointHandle joint = out.machine.joint(functions[i].joint);
    // The axes alternate: left x, left y, right x, right y.
    const std::string direction = i % 2 == 0 ? "to the right" : "away";
    const double sign = functions[i].sign, band = built.levers.dead_band;
    out.inputs.add({out.prefix + "levers/" + vehicle::kLeverNames[i], "1",
                    "-1 to 1, positive " + direction + "; opens the valve of " + joint.name(),
                    out.machine.index(), -1, 1},
                   [&world = out.world, joint, sign, band](double lever) {
                     const double opening = sign * vehicle::lever_opening(lever, band);
                     world.commands().set(joint, {vehicle::JointMode::kOpening, opening});
                   });
  }
}

}  // namespace navvy::sim
