// SPDX-License-Identifier: Apache-2.0
#include "terramechanics/tyre_track.h"

#include <algorithm>
#include <cmath>

namespace navvy::terramechanics {
namespace {

constexpr double kReboundSpeed = 0.25;  // [m/s] tuned: BulletDrive.DropsIntoATrenchWithoutBeingLaunched
constexpr double kBristleShare = 0.8;   // tangential over radial stiffness of a bias truck tyre, 0.5 to 1 (U)
constexpr double kRelaxation = 0.6;     // of the radius [Pacejka 2012, 7.2: about the contact's half length to radius]

}  // namespace

double track_offset(const scene::Wheel& tyre) {
  // The tyres of a pair, or the middles of the two halves of a single tyre, which then resists leaning.
  return tyre.twin_spacing > 0 ? 0.5 * tyre.twin_spacing : 0.25 * tyre.width;
}

double radial_force(const scene::Wheel& tyre, double share, double deflection, double closing) {
  const double force = share * (tyre.stiffness * deflection + tyre.damping * closing);
  // Leaving the ground, the spring gives back less and less, nothing at the rebound speed.
  const double taper = closing < 0 ? std::max(0.0, 1 + closing / kReboundSpeed) : 1.0;
  return std::clamp(force * taper, 0.0, 2 * share * tyre.stiffness * kMaxDeflection * tyre.radius);
}

Vec2 bristle_force(const scene::Wheel& tyre, double share, const Vec2& slip, double rolling, double limit,
                   double rim_mass, double dt, Vec2& bristle) {
  // An explicit step stays stable while k dt^2 and c dt are well below the rim's mass.
  const double k = std::min(kBristleShare * share * tyre.stiffness, 0.2 * share * rim_mass / (dt * dt));
  const double c = std::min(share * tyre.damping, 0.3 * share * rim_mass / dt);
  // Fresh, unstretched bristles roll in at the rolling speed.
  bristle = (bristle + dt * slip) / (1 + dt * std::abs(rolling) / (kRelaxation * tyre.radius));
  const double stretched = k * bristle.norm();
  if (stretched > limit) bristle *= limit / stretched;
  Vec2 force = -k * bristle - c * slip;
  if (force.norm() > limit) force *= limit / force.norm();
  return force;
}

}  // namespace navvy::terramechanics
