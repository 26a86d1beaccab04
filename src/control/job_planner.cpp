// SPDX-License-Identifier: Apache-2.0
#include "control/job_planner.h"

namespace navvy::control {

void JobCut::visit(Archive& a) {
  a("near", near);
  a("far", far);
  a("floor", floor);
  a.require(floor.size() >= 2, "floor", "a cut has at least two heights");
  a("rim", rim);
  a("dump_at", dump_at);
  a("has_dump_at", has_dump_at);
  a("key", key);
  a("levels", levels);
  a("fill", fill);
  a("worth", worth);
}

void JobStation::visit(Archive& a) {
  a("p", at.p);
  a("yaw", at.yaw);
  a("cuts", cuts);
  a("volume", volume);
}

}  // namespace navvy::control
