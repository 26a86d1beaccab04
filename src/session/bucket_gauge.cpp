// SPDX-License-Identifier: Apache-2.0
#include "session/bucket_gauge.h"

#include <algorithm>

namespace navvy::session {
namespace {

/// Speed below which the direction of the cutting edge is noise [m/s].
constexpr double kMoving = 0.05;

}  // namespace

BucketLoad load_of(const Vec3& force, const vehicle::LinkState& link, const Vec3& p_tip) {
  const Vec3 edge = link.v_WL + link.w_WL.cross(link.X_WL.linear() * p_tip);
  const double speed = edge.norm();
  return {force.norm(), speed > kMoving ? std::max(0.0, -force.dot(edge) / speed) : 0.0,
          std::max(0.0, force.z())};
}

}  // namespace navvy::session
