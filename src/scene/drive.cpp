// SPDX-License-Identifier: Apache-2.0
#include "scene/drive.h"

#include <algorithm>
#include <cmath>

namespace navvy::scene {

Vec2 steering_arm(const LinkageDrive& drive) {
  const double out = 0.5 * (drive.tie_rod - drive.track);
  return {(drive.ahead ? 1 : -1) * std::sqrt(drive.arm * drive.arm - out * out), out};
}

bool turns_freely(const LinkageDrive& drive) {
  const Vec2 arm = steering_arm(drive);
  if (!arm.allFinite()) return false;
  // It locks where tie rod and right arm lie in one line: the left arm's end is then as far from the right king pin as
  // both are long. Turned to the right it is the same in a mirror.
  for (double angle = 0; angle < drive.max_steer + radians(0.5); angle += radians(0.5)) {
    const double far = (Vec2(0, drive.track) + Eigen::Rotation2Dd(std::min(angle, drive.max_steer)) * arm).norm();
    if (far > drive.tie_rod + drive.arm || far < std::abs(drive.tie_rod - drive.arm)) return false;
  }
  return true;
}

}  // namespace navvy::scene
