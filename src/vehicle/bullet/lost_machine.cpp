// SPDX-License-Identifier: Apache-2.0
#include "vehicle/bullet/lost_machine.h"

#include <array>
#include <cstdio>

#include "vehicle/collision_box.h"

namespace navvy::vehicle {

std::string cause_of_loss(const BulletMachine& machine, const BulletMachine* load) {
  std::array<char, 400> text{};
  for (const scene::Link& link : machine.scene().links) {
    const InertiaShare inertia = inertia_share(link);
    if (inertia.share >= kLeastInertiaShare) continue;
    std::snprintf(text.data(), text.size(),
                  ": the inertia of its link '%s' is %.3g kg m2, and a solid body of its shape and "
                  "mass has %.3g kg m2; correct <inertia>, or give a density",
                  link.name.c_str(), inertia.inertia, inertia.expected);
    return text.data();
  }
  const double mass = machine.tree().total_mass();
  if (load == nullptr || !(load->tree().total_mass() > kMostMassRatio * mass)) return "";
  std::snprintf(
      text.data(), text.size(),
      ": '%s' of %.4g kg has pressed on it, and it has %.4g kg; contacts carry a ratio of "
      "masses up to %.0f: give the light one more mass, or fix it to the heavy one",
      load->scene().name.c_str(), load->tree().total_mass(), mass, kMostMassRatio);
  return text.data();
}

}  // namespace navvy::vehicle
