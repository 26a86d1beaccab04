// SPDX-License-Identifier: Apache-2.0
#include "vehicle/bullet/hydraulics.h"

#include <algorithm>
#include <cmath>

#include "vehicle/bullet/refuse.h"

namespace navvy::vehicle {

Hydraulics::Hydraulics(const scene::Machine& machine)
    : machine_(machine), of_joint_(machine.joints.size(), -1) {
  // Cylinders in the order of the machine; a joint stores the index of its cylinder.
  for (const scene::Cylinder& cylinder : machine.cylinders) {
    cylinders_.push_back({CylinderMap(machine, cylinder), {}, {}});
    int& slot = of_joint_[static_cast<std::size_t>(cylinders_.back().map.joint())];
    if (slot >= 0)
      refuse("cylinder[" + cylinder.name + "]", cylinder.joint,
             "only one cylinder per joint; for several side by side set count");
    slot = count() - 1;
  }
}

void Hydraulics::place(int cylinder, double q) {
  // Compute length, lever and limits together: each linkage is evaluated once.
  Cylinder& c = cylinders_[static_cast<std::size_t>(cylinder)];
  c.geometry = c.map.geometry(q);
  c.limits = c.map.limits(c.geometry);
}

double Hydraulics::oil(int cylinder, double velocity) const {
  const scene::Cylinder& about = machine_.cylinders[static_cast<std::size_t>(cylinder)];
  // Speed of the piston by the lever: extending fills the head side, retracting the rod side.
  const double piston = velocity * at(cylinder).geometry.lever;
  return std::abs(piston) * (piston > 0 ? head_area(about) : rod_area(about));
}

// Flow follows from the velocity that the valve allows.
OilDemand Hydraulics::demand(int cylinder, double opened, double effort, bool flows) const {
  OilDemand demand{oil(cylinder, opened), 0};
  // The load's pressure is the relief pressure times the effort over the largest effort in that
  // direction. A load that assists has no pressure.
  const CylinderLimits& limits = at(cylinder).limits;
  const double most = opened > 0 ? limits.torque_positive : -limits.torque_negative;
  if (flows && effort * most > 0)
    demand.pressure = std::min(effort / most, 1.0) *
                      machine_.cylinders[static_cast<std::size_t>(cylinder)].pressure;
  return demand;
}

}  // namespace navvy::vehicle
