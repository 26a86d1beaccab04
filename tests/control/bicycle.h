// SPDX-License-Identifier: Apache-2.0
// A bicycle that rolls without slip, with limited steering rate and delayed speed: the drive of an
// ew180 as the control laws see it.
#pragma once

#include <algorithm>
#include <cmath>

#include "control/pursuit.h"
#include "vehicle/drive/drive_input.h"

namespace navvy::control::testing {

struct Bicycle {
  static constexpr double kStep = 0.005;  // [s]
  PlanePose at;
  double speed = 0, steer = 0;
  bool braked = false;
  double fastest = 0;  // [m/s]
  double most_acceleration = 0;

  void step(const vehicle::DriveInput& input) {
    // Time constant of the drive [s].
    constexpr double kLag = 0.2;
    const double before = speed;
    speed += ((input.brake ? 0 : input.speed) - speed) * kStep / (input.brake ? 0.05 : kLag);
    most_acceleration =
        std::max(most_acceleration, input.brake ? 0.0 : std::abs(speed - before) / kStep);
    steer += std::clamp(input.steer - steer, -radians(30) * kStep, radians(30) * kStep);
    at.p += speed * kStep * Vec2(std::cos(at.yaw), std::sin(at.yaw));
    at.yaw += speed * kStep * std::tan(steer) / 2.8;
    fastest = std::max(fastest, std::abs(speed));
    braked = input.brake;
  }
};

}  // namespace navvy::control::testing
