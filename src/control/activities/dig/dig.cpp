// SPDX-License-Identifier: Apache-2.0
// The dig step as a scene describes it; dig_reach.cpp looks at its targets, digging.h carries it
// out.
#include "control/activities/dig/dig.h"

#include "control/activities/dig/digging.h"

namespace navvy::control {

Dig Dig::read(const scene::StepSource& source) {
  constexpr scene::Range kPlace = {-1e6, 1e6};  // [m]
  Dig step;
  scene::FieldSource& fields = source.fields;
  int cycles = 0;
  const scene::Machine* machine = source.machine;
  // Who says nothing digs as wide as the bucket cuts.
  if (machine && !machine->buckets.empty()) step.width = machine->buckets[0].width;
  fields.vec2("from_m", step.from, kPlace)
      .required("from_m")
      .vec2("to_m", step.to, kPlace)
      .required("to_m")
      .number("depth_m", step.depth, {0.02, 20})
      .required("depth_m")
      .number("width_m", step.width, {0.05, 50})
      .vec2("dump_at_m", step.dump_at, kPlace)
      .required("dump_at_m")
      .number("dump_height_m", step.dump_height, {0.1, 10})
      .number("pass_depth_m", step.pass_depth, {0.02, 5})
      .whole("max_cycles", cycles, {1, 100000})
      .finish();
  if (cycles > 0) step.max_cycles = cycles;
  // What inverse kinematics needs; the swing joint is asked for by the operator.
  const bool can = machine && !machine->buckets.empty() && !machine->arm.boom.empty() &&
                   !machine->arm.stick.empty() && !machine->arm.bucket.empty();
  source.require(can,
                 "dig needs a machine with <navvy:bucket> and <navvy:arm> (boom, stick, bucket)");
  source.on_site("from_m", step.from);
  source.on_site("to_m", step.to);
  source.on_site("dump_at_m", step.dump_at);
  // Without a length the trench has no direction.
  if (fields.has("from_m") && fields.has("to_m") && (step.to - step.from).norm() < 0.1)
    fields.error("to_m", fields.written("to_m"), "must lie at least 0.1 m from from_m");
  // Columns end at the ground's depth; the arm would stand on rock.
  if (source.ground && step.depth > source.ground->depth)
    fields.error("depth_m", fields.written("depth_m"), "must not exceed depth_m of the ground",
                 "there is rock below; make the ground deeper");
  return step;
}

std::unique_ptr<Activity> Dig::activity(OperatorContext& place) const {
  return std::make_unique<Digging>(place, *this);
}

}  // namespace navvy::control
