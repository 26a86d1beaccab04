// SPDX-License-Identifier: Apache-2.0
#include "control/activities/dig/fill.h"

#include <algorithm>
#include <cmath>

#include "scene/friction.h"

namespace navvy::control {
namespace {

// Fill factors of handbooks: loam 1.0 to 1.1, moist clay 0.9 to 1.05, hard clay 0.8 to 0.9, poorly
// blasted rock 0.6 to 0.75. Of a heap over the mouth some falls when the bucket leaves the ground:
// in moist clay an aim of 0.9 brings 0.83, and 1.05 brings 0.90.
constexpr double kLoam = 1.05, kMoistClay = 1.05, kClay = 0.9, kBrokenRock = 0.7;
// Limits between the kinds of soil: swell [-], cohesion of any and of hard clay [Pa], friction
// angle [rad].
constexpr double kRockSwell = 1.5, kLeastCohesion = 1500, kHardClay = 15e3,
                 kClayFriction = radians(24);

}  // namespace

bool is_cohesionless(const scene::Soil& soil) { return soil.cohesion < kLeastCohesion; }

double usual_fill(const scene::Soil& soil, const ArmKinematics& arm) {
  if (soil.swell >= kRockSwell) return kBrokenRock;
  if (!is_cohesionless(soil) && soil.friction_angle < kClayFriction)
    return soil.cohesion < kHardClay ? kMoistClay : kClay;
  if (!is_cohesionless(soil)) return kLoam;
  // Repose does not depend on dilatancy.
  const double repose = soil.has_repose_angle ? soil.repose_angle
                                              : scene::angle_in_test(scene::FrictionTest::kRepose,
                                                                     soil.friction_angle, 0);
  const double struck = arm.struck_capacity() / arm.bucket().capacity;
  if (!(struck > 0 && struck < 1)) return kClay;
  return struck + (1 - struck) * std::min(1.0, std::tan(repose));
}

scene::Soil surface_soil(const heightfield::Ground& ground, const Vec2& p) {
  const Vec2i cell = ground.column_at(p.x(), p.y());
  const auto& soils = ground.setup().soils;
  const std::size_t kind =
      ground.contains(cell.x(), cell.y()) ? ground.surface_soil(cell.x(), cell.y()) : 0;
  return kind < soils.size() ? soils[kind] : scene::Soil{};
}

}  // namespace navvy::control
