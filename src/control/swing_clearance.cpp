// SPDX-License-Identifier: Apache-2.0
#include "control/swing_clearance.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace navvy::control {
namespace {

constexpr int kSamples = 64;  // of a move: at most 0.5 m apart in a half turn at full reach

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

}  // namespace navvy::control
