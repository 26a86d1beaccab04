// SPDX-License-Identifier: Apache-2.0
#include "sim/placing.h"

#include "coupling/placing.h"

namespace navvy::sim {

std::vector<Pose> starting_poses(const scene::Scene& scene, const heightfield::Ground& ground) {
  std::vector<Pose> X_WB;
  X_WB.reserve(scene.machines.size());
  for (const scene::MachineInWorld& placed : scene.machines)
    X_WB.push_back(coupling::base_pose(placed.machine, coupling::place(placed, ground)));
  return X_WB;
}

}  // namespace navvy::sim
