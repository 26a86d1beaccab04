// SPDX-License-Identifier: Apache-2.0
#include "scene/drive.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace navvy::scene {

CombustionEngine::Point rated_point(const CombustionEngine& engine) {
  CombustionEngine::Point best;
  const auto try_at = [&](double speed, double torque) {
    if (speed * torque > best.speed * best.torque) best = {speed, torque};
  };
  for (std::size_t i = 0; i < engine.curve.size(); ++i) {
    const CombustionEngine::Point& to = engine.curve[i];
    try_at(to.speed, to.torque);
    if (i == 0) continue;
    // Power along T = a + b w is a parabola with its top at -a / (2 b).
    const CombustionEngine::Point& from = engine.curve[i - 1];
    const double b = (to.torque - from.torque) / (to.speed - from.speed),
                 a = from.torque - b * from.speed;
    const double top = b < 0 ? -0.5 * a / b : to.speed;
    if (top > from.speed && top < to.speed) try_at(top, a + b * top);
  }
  return best;
}

Vec2 steering_arm(const LinkageDrive& drive) {
  const double out = 0.5 * (drive.tie_rod - drive.track);
  return {(drive.ahead ? 1 : -1) * std::sqrt(drive.arm * drive.arm - out * out), out};
}

bool turns_freely(const LinkageDrive& drive) {
  const Vec2 arm = steering_arm(drive);
  if (!arm.allFinite()) return false;
  // It locks where tie rod and right arm are in line: the left arm's end is then as far from the
  // right king pin as both are long. Turning to the right is symmetric.
  for (double angle = 0; angle < drive.max_steer + radians(0.5); angle += radians(0.5)) {
    const double far =
        (Vec2(0, drive.track) + Eigen::Rotation2Dd(std::min(angle, drive.max_steer)) * arm).norm();
    if (far > drive.tie_rod + drive.arm || far < std::abs(drive.tie_rod - drive.arm)) return false;
  }
  return true;
}

namespace {

/// Returns a drive of every kind, in the order of the variant: the default first.
template <std::size_t... I>
std::vector<Drive> drive_of_each_kind(std::index_sequence<I...>) {
  return {std::variant_alternative_t<I, Drive>()...};
}

}  // namespace

void describe_drive(Fields& f, Drive& drive) {
  static const std::vector<Drive> kinds =
      drive_of_each_kind(std::make_index_sequence<std::variant_size_v<Drive>>());
  Types types{"type", "Kind of the drive.", {}, drive.index(), {}, {}};
  for (const Drive& kind : kinds) types.names.push_back(drive_name(kind));
  types.choose = [&drive](std::size_t i) { drive = kinds.at(i); };
  types.describe = [&drive](std::size_t i, Fields& inner) {
    Drive fresh = kinds.at(i);
    std::visit([&inner](auto& kind) { kind.describe(inner); }, i == drive.index() ? drive : fresh);
  };
  f.types(types);
}

}  // namespace navvy::scene
