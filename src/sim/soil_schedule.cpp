// SPDX-License-Identifier: Apache-2.0
#include "sim/soil_schedule.h"

#include "soil/particles/schedule.h"

namespace navvy::sim {

std::string soil_schedule(const device::Device& device) {
  return soil::schedule_for(device) == soil::Schedule::kGroups ? "groups" : "lanes";
}

}  // namespace navvy::sim
