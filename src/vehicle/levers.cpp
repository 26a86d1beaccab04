// SPDX-License-Identifier: Apache-2.0
#include "vehicle/levers.h"

#include <algorithm>
#include <cmath>

namespace navvy::vehicle {
namespace {

/// Returns the function of a joint that turns by the right-hand rule about `axis` of M, or about
/// its opposite.
LeverFunction turns(const scene::Machine& machine, const std::string& name, const Vec3& axis) {
  LeverFunction out;
  out.joint = machine.joint_index(name);
  if (out.joint < 0) return out;
  const scene::Joint& joint = machine.joints[static_cast<std::size_t>(out.joint)];
  const Pose& X_ML = machine.links[static_cast<std::size_t>(joint.child)].X_ML;
  const Vec3 axis_M = X_ML.linear() * joint.X_LcJ.linear() * joint.axis;
  out.sign = axis_M.dot(axis) < 0 ? -1 : 1;
  return out;
}

}  // namespace

// Both patterns differ only in which lever moves boom and stick.
LeverFunctions lever_functions(const scene::Machine& machine) {
  // Effect of a lever to the right or away: an arm that points ahead (+x) is lowered about +y and
  // lifted about -y.
  const LeverFunction swing = turns(machine, machine.arm.swing, -Vec3::UnitZ());
  const LeverFunction boom = turns(machine, machine.arm.boom, Vec3::UnitY());
  const LeverFunction stick = turns(machine, machine.arm.stick, -Vec3::UnitY());
  const LeverFunction bucket = turns(machine, machine.arm.bucket, -Vec3::UnitY());
  const bool iso = machine.levers.pattern == scene::Levers::Pattern::kIso;
  return {swing, iso ? stick : boom, bucket, iso ? boom : stick};
}

double lever_opening(double deflection, double dead_band) {
  const double beyond = std::min(std::abs(deflection), 1.0) - dead_band;
  return beyond > 0 ? std::copysign(beyond / (1 - dead_band), deflection) : 0;
}

}  // namespace navvy::vehicle
