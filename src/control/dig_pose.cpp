// SPDX-License-Identifier: Apache-2.0
#include "control/dig_pose.h"

#include <algorithm>
#include <cmath>

namespace navvy::control {

SwingPoint swing_point(const Pose& X_WS, const Vec3& p_W) {
  // Swing rotates about S's z axis, which tilts with the machine, so everything is computed in S,
  // not in W.
  const Vec3 p = X_WS.inverse() * p_W;
  SwingPoint out;
  out.swing = std::atan2(p.y(), p.x());
  out.reach = std::hypot(p.x(), p.y());
  out.height = p.z();
  // A line that is level in W is pitched by this in S.
  const Vec3 outward = X_WS.linear() * Vec3(std::cos(out.swing), std::sin(out.swing), 0);
  out.pitch = std::asin(outward.z());
  return out;
}

bool dump_pose(const ArmKinematics& arm, const Pose& X_WS, const Vec2& dump_at, double ground,
               double clearance, ArmAngles& q, double& possible) {
  constexpr double kLeast = 0.3, kStep = 0.05;
  // Opened, the bucket drops its soil roughly below the pin, which is therefore placed over the
  // dump point. Try from the wanted clearance downwards, in steps too small to show on the heap.
  for (double c = clearance; c >= std::min(kLeast, clearance) - 1e-9; c -= kStep) {
    const double pin = ground + c - arm.bucket_length() * std::sin(kOpen);
    const SwingPoint p = swing_point(X_WS, Vec3(dump_at.x(), dump_at.y(), pin));
    // Level now, with the pin where it will be when the bucket opens, so that only the bucket joint
    // moves then.
    const double angle = p.level(kCarry);
    possible = c;
    if (arm.inverse({p.reach + arm.bucket_length() * std::cos(angle),
                     p.height + arm.bucket_length() * std::sin(angle), angle},
                    q))
      return true;
  }
  return false;
}

double heap_height(const SurfaceView& surface, const Vec2& p) {
  constexpr double kHeapRadius = 0.6;  // around the dump point [m]
  double highest = surface.height(p.x(), p.y());
  for (int i = 0; i < 8; ++i)
    for (const double r : {0.5 * kHeapRadius, kHeapRadius}) {
      const double a = i * kPi / 4;
      highest = std::max(highest, surface.height(p.x() + r * std::cos(a), p.y() + r * std::sin(a)));
    }
  return highest;
}

bool can_dig_at(const ArmKinematics& arm, double reach, double height, double pitch) {
  // The bucket may rotate away from its plunging angle, as it does when it digs.
  BucketPose pose{reach, height, with_cut(arm, kPlunge) - pitch};
  ArmAngles q;
  return arm.inverse_nearest(pose, q);
}

TipReach tip_reach(const ArmKinematics& arm, double height, double pitch) {
  TipReach out;
  for (double r = 0.5; r < arm.longest() + 2; r += 0.02) {
    if (!can_dig_at(arm, r, height, pitch)) continue;
    if (out.most == 0) out.least = r;
    out.most = r;
  }
  return out;
}

}  // namespace navvy::control
