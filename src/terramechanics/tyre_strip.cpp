// SPDX-License-Identifier: Apache-2.0
#include "terramechanics/tyre_strip.h"

#include <algorithm>
#include <cmath>

#include "terramechanics/shear.h"

namespace navvy::terramechanics {
namespace {

// [m/s] tuned: BulletDrive.DropsIntoATrenchWithoutBeingLaunched
constexpr double kReboundSpeed = 0.25;
// Tangential over radial stiffness of a bias truck tyre, 0.5 to 1 (U)
constexpr double kBristleShare = 0.8;
// Of Newton; what is left of the force is below 1e-4 of the limit
constexpr int kYieldSteps = 6;
// [K]: 0.9997 of the strength; a wheel that was dragged far forgets it in two l
constexpr double kFullyMobilised = 8;
// Of the radius [Pacejka 2012, 7.2: about the contact's half length to radius]
constexpr double kRelaxation = 0.6;

}  // namespace

double track_offset(const scene::Wheel& tyre) {
  // The tyres of a pair, or the middles of the two halves of a single tyre, which then resists
  // leaning.
  return tyre.twin_spacing > 0 ? 0.5 * tyre.twin_spacing : 0.25 * tyre.width;
}

double radial_force(const scene::Wheel& tyre, double share, double deflection, double closing) {
  const double force = share * (tyre.stiffness * deflection + tyre.damping * closing);
  // Leaving the ground, the spring gives back less and less, nothing at the rebound speed.
  const double taper = closing < 0 ? std::max(0.0, 1 + closing / kReboundSpeed) : 1.0;
  return std::clamp(force * taper, 0.0, 2 * share * tyre.stiffness * kMaxDeflection * tyre.radius);
}

namespace {

/// Spring and damper of a track's tread along the ground [N/m], [N s/m].
struct Tread {
  double k, c;
};

Tread tread_of(const scene::Wheel& tyre, double share, double rim_mass, double dt) {
  // An explicit step stays stable while k dt^2 and c dt are well below the rim's mass.
  return {std::min(kBristleShare * share * tyre.stiffness, 0.2 * share * rim_mass / (dt * dt)),
          std::min(share * tyre.damping, 0.3 * share * rim_mass / dt)};
}

/// Fresh, unstretched bristles roll in at the rolling speed.
void stretch(const scene::Wheel& tyre, const Vec2& slip, double rolling, double dt, Vec2& bristle) {
  bristle = (bristle + dt * slip) / (1 + dt * std::abs(rolling) / (kRelaxation * tyre.radius));
}

/// How far [m] soil yields until what it bears, sheared by so much more, is the pull of the bristle
/// that slackens by as much: limit (1 - exp(-(j + d) / K)) = k (u - d). Newton's steps from below
/// stay below, as the left side bends down; the start leaves a few K to go.
double yielding(const TrackShear& soil, double k, double stretched, double sheared) {
  double d = std::max(0.0, stretched - soil.limit / k);
  for (int i = 0; i < kYieldSteps; ++i) {
    const double left = std::exp(-(sheared + d) / soil.janosi_k);
    d += (k * (stretched - d) - soil.limit * (1 - left)) / (soil.limit / soil.janosi_k * left + k);
  }
  return std::clamp(d, 0.0, stretched);
}

}  // namespace

Vec2 bristle_force(const scene::Wheel& tyre, double share, const Vec2& slip, double rolling,
                   double limit, double rim_mass, double dt, Vec2& bristle) {
  const auto [k, c] = tread_of(tyre, share, rim_mass, dt);
  stretch(tyre, slip, rolling, dt, bristle);
  const double stretched = k * bristle.norm();
  if (stretched > limit) bristle *= limit / stretched;
  Vec2 force = -k * bristle - c * slip;
  if (force.norm() > limit) force *= limit / force.norm();
  return force;
}

Vec2 shear_force(const scene::Wheel& tyre, double share, const Vec2& slip, double rolling,
                 const TrackShear& soil, double rim_mass, double dt, Vec2& bristle,
                 double& sheared) {
  const auto [k, c] = tread_of(tyre, share, rim_mass, dt);
  stretch(tyre, slip, rolling, dt, bristle);
  sheared /= 1 + dt * std::abs(rolling) / soil.half_length;
  const double stretched = bristle.norm();
  double bears = soil.limit * mobilised_share(sheared, soil.janosi_k);
  if (k * stretched > bears) {
    const double yielded = yielding(soil, k, stretched, sheared);
    sheared = std::min(sheared + yielded, kFullyMobilised * soil.janosi_k);
    bristle *= (stretched - yielded) / stretched;
    bears = k * (stretched - yielded);
  }
  Vec2 force = -k * bristle - c * slip;
  if (force.norm() > bears) force *= bears / force.norm();
  return force;
}

}  // namespace navvy::terramechanics
