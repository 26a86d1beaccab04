// SPDX-License-Identifier: Apache-2.0
#include "control/stance.h"

#include <algorithm>
#include <cmath>

#include "control/profile.h"

namespace navvy::control {
namespace {

// The chassis moves on its tyres; at twice this tilt the arm waits.
constexpr double kTilt = radians(1.5);
constexpr double kBaseTime = 0.25;  // smoothing of the chassis' pose [s]

}  // namespace

void Stance::begin(const Pose& X_WB) {
  const Eigen::Quaterniond q(X_WB.linear());
  const Vec3 p = X_WB.translation();
  base_ = {p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()};
  settle();
}

void Stance::settle() {
  const Vec3 up =
      Eigen::Quaterniond(base_[3], base_[4], base_[5], base_[6]).normalized() * Vec3::UnitZ();
  up_ = {up.x(), up.y(), up.z()};
}

void Stance::follow(const Pose& X_WB, double dt) {
  // A first-order filter, exact for any step.
  const double share = 1 - std::exp(-dt / kBaseTime);
  const Eigen::Quaterniond now(X_WB.linear());
  const Eigen::Quaterniond q =
      Eigen::Quaterniond(base_[3], base_[4], base_[5], base_[6]).slerp(share, now);
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    base_[k] = mix(base_[k], X_WB.translation()[i], share);
  }
  base_[3] = q.w();
  base_[4] = q.x();
  base_[5] = q.y();
  base_[6] = q.z();
}

Pose Stance::swing_frame(const ArmKinematics& arm) const {
  Pose X_WB = Pose::Identity();
  // slerp preserves the length only to rounding.
  X_WB.linear() =
      Eigen::Quaterniond(base_[3], base_[4], base_[5], base_[6]).normalized().toRotationMatrix();
  X_WB.translation() = Vec3(base_[0], base_[1], base_[2]);
  return X_WB * arm.X_BS();
}

double Stance::rise(const Pose& X_WB, const ArmKinematics& arm, double swing) const {
  // Sine of the angle between the arm's direction and the plane of the base at the last settling;
  // rotation about the vertical and roll to the arm's side do not count.
  const Vec3 outward =
      X_WB.linear() * arm.X_BS().linear() * Vec3(std::cos(swing), std::sin(swing), 0);
  return std::asin(std::clamp(outward.dot(Vec3(up_[0], up_[1], up_[2])), -1.0, 1.0));
}

double Stance::tilt_factor(const Pose& X_WB) const {
  // Sine of the angle between the base's z axis then and now, as in rise.
  const double tilt = Vec3(up_[0], up_[1], up_[2]).cross(Vec3(X_WB.linear().col(2))).norm();
  return std::clamp(2 - tilt / kTilt, 0.0, 1.0);
}

}  // namespace navvy::control
