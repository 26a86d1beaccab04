// SPDX-License-Identifier: Apache-2.0
#include "control/swing_clearance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "control/dig_pose.h"

namespace navvy::control {
namespace {

constexpr int kSamples = 64;  // of a move: at most 0.5 m apart in a half turn at full reach

/// Returns the height in W [m] of the tip after the bucket has opened at the angles `q`.
double opened_height(const ArmAngles& q, const ArmKinematics& arm, const Pose& X_WS) {
  const BucketPose at = arm.forward(q);
  const double pin = at.height - arm.bucket_length() * std::sin(at.angle);
  return X_WS.translation().z() + pin + arm.bucket_length() * std::sin(kOpen);
}

}  // namespace

double least_clearance(const ArmMove& move, double since, const ArmKinematics& arm,
                       const Pose& X_WS, const SurfaceView& surface) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= kSamples; ++i) {
    const Axes q = move.at(since + i * (move.duration() - since) / kSamples);
    const BucketPose tip = arm.forward({q[1], q[2], q[3]});
    const Vec3 out(std::cos(q[0]), std::sin(q[0]), 0), across(-out.y(), out.x(), 0);
    const double low = tip.height - arm.below_tip(tip.angle);
    for (const double side : {-0.5, 0.0, 0.5}) {
      const Vec3 p =
          X_WS * Vec3(tip.reach * out + side * arm.bucket().width * across + low * Vec3::UnitZ());
      least = std::min(least, p.z() - surface.height(p.x(), p.y()));
    }
  }
  return least;
}

double lowest_point(const BucketPose& pose, const ArmKinematics& arm, const Pose& X_WS) {
  return X_WS.translation().z() + pose.height - arm.below_tip(pose.angle);
}

double highest_on_arc(const CarrySwing& swing, double share, const SurfaceView& surface) {
  const Vec2 axis = swing.X_WS.translation().head<2>();
  const double reach = (swing.dump_at - axis).norm();
  double highest = -std::numeric_limits<double>::infinity();
  for (int i = 0; i <= kSamples; ++i) {
    const double angle = swing.from + share * (swing.to - swing.from) * i / kSamples;
    const Vec3 p = swing.X_WS * Vec3(reach * std::cos(angle), reach * std::sin(angle), 0);
    highest = std::max(highest, heap_height(surface, p.head<2>()));
  }
  return highest;
}

void pass_over(const ArmKinematics& arm, const SurfaceView& surface, CarrySwing& swing,
               ArmAngles& q) {
  const double wanted = highest_on_arc(swing, 1, surface) + kOverHeap;
  if (opened_height(q, arm, swing.X_WS) >= wanted) return;
  ArmAngles raised = q;
  double clearance = 0;
  // As high as it must be and no higher.
  if (dump_pose(arm, swing.X_WS, swing.dump_at, wanted, 0, raised, clearance)) {
    q = raised;
    return;
  }
  if (arm.swing_limited()) return;
  CarrySwing other = swing;
  other.to += std::copysign(2 * kPi, swing.from - swing.to);
  if (opened_height(q, arm, swing.X_WS) >= highest_on_arc(other, 1, surface) + kOverHeap)
    swing = other;
}

}  // namespace navvy::control
