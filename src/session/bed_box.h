// SPDX-License-Identifier: Apache-2.0
// Bounding box of a bed. Private to session.
#pragma once

#include <Eigen/Geometry>

#include "core/math.h"
#include "scene/machine.h"

namespace navvy::session {

/// Returns the bounding box of the shell of a bed [m], in the frame A in which the bed's link has
/// the pose `X_AL`.
inline Eigen::AlignedBox3d bed_box(const scene::Machine& machine, const scene::Bed& bed,
                                   const Pose& X_AL) {
  Eigen::AlignedBox3d out;
  for (const scene::Shell& shell : machine.shells)
    if (shell.name == bed.shell)
      for (const Vec3& v : shell.vertices) out.extend(Vec3(X_AL * v));
  return out;
}

}  // namespace navvy::session
