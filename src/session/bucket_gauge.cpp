// SPDX-License-Identifier: Apache-2.0
#include "session/bucket_gauge.h"

#include <algorithm>

namespace navvy::session {
namespace {

constexpr double kMoving = 0.05;  // a slower lip rests: its direction is noise [m/s]

}  // namespace

BucketLoad load_of(const Vec3& force, const vehicle::LinkState& link, const Vec3& p_tip) {
  const Vec3 lip = link.v_WL + link.w_WL.cross(link.X_WL.linear() * p_tip);
  const double speed = lip.norm();
  return {force.norm(), speed > kMoving ? std::max(0.0, -force.dot(lip) / speed) : 0.0,
          std::max(0.0, force.z())};
}

}  // namespace navvy::session
