// SPDX-License-Identifier: Apache-2.0
// The dig step as a scene describes it; dig_reach.cpp checks its targets, digging.h carries it out.
#include "control/activities/dig/dig.h"

#include "control/activities/dig/digging.h"

namespace navvy::control {

void Dig::check(const scene::StepSource& source) {
  const scene::Machine* machine = source.machine;
  const bool has_bucket = machine && !machine->buckets.empty();
  if (has_bucket && !source.has("width_m")) width = machine->buckets[0].width;
  // Needs of the inverse kinematics; the operator asks for the swing joint.
  const bool can = has_bucket && !machine->arm.boom.empty() && !machine->arm.stick.empty() &&
                   !machine->arm.bucket.empty();
  source.require(can,
                 "dig needs a machine with <navvy:bucket> and <navvy:arm> (boom, stick, bucket)");
  source.on_site("from_m", from);
  source.on_site("to_m", to);
  source.on_site("dump_at_m", dump_at);
  if (has_load && !has_into)
    source.error("load_kg", source.written("load_kg"), "needs the machine that is loaded",
                 "name it in <into>");
  // Without a length the trench has no direction.
  if (source.has("from_m") && source.has("to_m") && (to - from).norm() < 0.1)
    source.error("to_m", source.written("to_m"), "must be at least 0.1 m from from_m");
  if (source.ground && depth > source.ground->depth)
    source.error("depth_m", source.written("depth_m"), "must not exceed depth_m of the ground",
                 "there is rock below; make the ground deeper");
}

std::unique_ptr<Activity> Dig::activity(OperatorContext& place) const {
  return std::make_unique<Digging>(place, *this);
}

}  // namespace navvy::control
