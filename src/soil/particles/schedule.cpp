// SPDX-License-Identifier: Apache-2.0
#include "soil/particles/schedule.h"

#include <cstdlib>

#include "core/error.h"

namespace navvy::soil {

Schedule schedule_for(const device::Device& device) {
  const char* text = std::getenv("NAVVY_SOIL_SCHEDULE");
  const std::string wanted = text == nullptr ? "" : text;
  if (wanted == "lanes") return Schedule::kLanes;
  if (wanted == "groups") return Schedule::kGroups;
  if (wanted.empty())
    return device.info().kind == device::Kind::kGpu ? Schedule::kGroups : Schedule::kLanes;
  Fault fault;
  fault.element = "NAVVY_SOIL_SCHEDULE";
  fault.value = wanted;
  fault.rule = "lanes or groups; unset, the device decides";
  throw InputError(fault);
}

std::string kernel_path(const device::Device& device, const std::string& stage) {
  return (schedule_for(device) == Schedule::kGroups ? "soil/groups/" : "soil/lanes/") + stage +
         ".cl";
}

}  // namespace navvy::soil
