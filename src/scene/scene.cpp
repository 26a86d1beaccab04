// SPDX-License-Identifier: Apache-2.0
#include "scene/scene.h"

#include <optional>
#include <utility>

namespace navvy::scene {

int Scene::soil_index(const std::string& name_of_soil) const {
  // A scene holds a few soils and machines; a search cannot get out of date.
  for (std::size_t i = 0; i < soils.size(); ++i)
    if (soils[i].name == name_of_soil) return static_cast<int>(i);
  return -1;
}

int Scene::machine_index(const std::string& name_of_machine) const {
  for (std::size_t i = 0; i < machines.size(); ++i)
    if (machines[i].name == name_of_machine) return static_cast<int>(i);
  return -1;
}

Design Scene::commanded_design() const {
  Design out = design;
  if (out.any()) return out;
  for (const MachineInWorld& machine : machines)
    for (const ProgramStep& step : machine.program.steps)
      if (std::optional<DesignArea> area = step->area()) out.areas.push_back(*std::move(area));
  return out;
}

}  // namespace navvy::scene
