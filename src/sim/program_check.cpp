// SPDX-License-Identifier: Apache-2.0
#include "sim/program_check.h"

#include <utility>

#include "control/operator.h"
#include "coupling/placing.h"
#include "heightfield/site.h"

namespace navvy::sim {

std::vector<Fault> check_programs(const scene::World& world, const control::SurfaceView& surface,
                                  const std::vector<Pose>& X_WB) {
  std::vector<Fault> faults;
  for (std::size_t m = 0; m < world.machines.size(); ++m) {
    const scene::MachineInWorld& placed = world.machines[m];
    for (Fault& fault : control::check_reach(placed.machine, placed.program, X_WB.at(m), surface, world.file))
      faults.push_back(std::move(fault));
  }
  return faults;
}

std::vector<Fault> check_programs(const scene::World& world) {
  try {
    const heightfield::Ground ground = heightfield::make_ground(world, nullptr);
    std::vector<Pose> X_WB;
    X_WB.reserve(world.machines.size());
    for (const scene::MachineInWorld& placed : world.machines) X_WB.push_back(coupling::place(placed, ground));
    return check_programs(world, control::GroundSurface(ground), X_WB);
  } catch (const InputError& error) {
    return error.faults();
  }
}

}  // namespace navvy::sim
