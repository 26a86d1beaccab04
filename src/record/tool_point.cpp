// SPDX-License-Identifier: Apache-2.0
#include "record/tool_point.h"

namespace navvy::record {

Vec3 tool_point(const scene::Shell& shell) {
  if (shell.toothed) return shell.toothed->p_tip;
  Vec3 sum = Vec3::Zero();
  for (const Vec3& p : shell.vertices) sum += p;
  return shell.vertices.empty() ? sum : Vec3(sum / static_cast<double>(shell.vertices.size()));
}

}  // namespace navvy::record
