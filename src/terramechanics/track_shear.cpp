// SPDX-License-Identifier: Apache-2.0
#include "terramechanics/track_shear.h"

#include <algorithm>
#include <cmath>

#include "terramechanics/shear.h"

namespace navvy::terramechanics {

TrackGrip track_grip(double most, double K, double mass, double dt) {
  return {most, std::max(K, most * dt * dt / (0.25 * mass))};
}

// Adds a damping that fades out with the track's speed, since moving shoes carry shear away.
Vec2 track_shear_force(const TrackGrip& grip, const Vec2& shear, const Vec2& slip,
                       double track_speed, double mass, double dt) {
  const auto [most, K] = grip;
  if (!(most > 0)) return Vec2::Zero();
  const double j = shear.norm(), share = mobilised_share(j, K);
  Vec2 force = j > 0 ? Vec2(-most * share / j * shear) : Vec2(Vec2::Zero());
  const double damping = std::min(0.8 * std::sqrt(most / K * mass), 0.3 * mass / dt);
  force -= damping * std::exp(-std::abs(track_speed) / kTrackRest) * slip;
  return force.norm() > most ? Vec2(most * force.normalized()) : force;
}

// Solves the transport along the segment implicitly.
Vec2 carry_shear(const Vec2& before, const Vec2& slip, double length, double track_speed,
                 double most, double dt, Vec2& shear) {
  const double carried = std::abs(track_speed) * dt / length;
  shear = (shear + dt * slip + carried * before) / (1 + carried);
  if (shear.norm() > most) shear *= most / shear.norm();
  // Shear grows linearly along the segment. If the track does not move, the whole segment is
  // sheared alike.
  const double rolls = 1 - std::exp(-std::abs(track_speed) / kTrackRest);
  return shear - 0.5 * rolls * (shear - before);
}

}  // namespace navvy::terramechanics
