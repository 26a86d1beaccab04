// SPDX-License-Identifier: Apache-2.0
#include "scene/machine.h"

namespace navvy::scene {

int Machine::link_index(const std::string& name_of_link) const {
  for (std::size_t i = 0; i < links.size(); ++i)
    if (links[i].name == name_of_link) return static_cast<int>(i);
  return -1;
}

int Machine::joint_index(const std::string& name_of_joint) const {
  for (std::size_t i = 0; i < joints.size(); ++i)
    if (joints[i].name == name_of_joint) return static_cast<int>(i);
  return -1;
}

}  // namespace navvy::scene
