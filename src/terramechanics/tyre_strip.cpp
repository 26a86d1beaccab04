// SPDX-License-Identifier: Apache-2.0
#include "terramechanics/tyre_strip.h"

#include <algorithm>
#include <cmath>

#include "terramechanics/shear.h"

namespace navvy::terramechanics {
namespace {

// [m/s] tuned: BulletDrive.DropsIntoATrenchWithoutBeingLaunched
constexpr double kReboundSpeed = 0.25;
// Tangential over radial stiffness of a bias-ply truck tyre, 0.5 to 1 (U).
constexpr double kBristleShare = 0.8;
// Newton iterations; the remaining force error is below 1e-4 of the limit.
constexpr int kYieldSteps = 6;
// Largest displacement in units of K: 0.9997 of the strength. A wheel that was dragged far recovers
// within two half lengths.
constexpr double kFullyMobilised = 8;
// Share of the radius [Pacejka 2012, 7.2: about the contact's half length to radius].
constexpr double kRelaxation = 0.6;

}  // namespace

double track_offset(const scene::Wheel& tyre) {
  // The tyres of a pair, or the middles of the two halves of a single tyre, so that it resists
  // tilting.
  return tyre.twin_spacing > 0 ? 0.5 * tyre.twin_spacing : 0.25 * tyre.width;
}

double radial_force(const scene::Wheel& tyre, double share, double deflection, double closing) {
  const double force = share * (tyre.stiffness * deflection + tyre.damping * closing);
  // On rebound the spring force fades, to zero at the rebound speed.
  const double taper = closing < 0 ? std::max(0.0, 1 + closing / kReboundSpeed) : 1.0;
  return std::clamp(force * taper, 0.0, 2 * share * tyre.stiffness * kMaxDeflection * tyre.radius);
}

namespace {

/// Tangential spring and damper of a strip's tread [N/m], [N s/m].
struct Tread {
  double k, c;
};

Tread tread_of(const scene::Wheel& tyre, double share, double rim_mass, double dt) {
  // An explicit step is stable while k dt^2 and c dt are well below the rim's mass.
  return {std::min(kBristleShare * share * tyre.stiffness, 0.2 * share * rim_mass / (dt * dt)),
          std::min(share * tyre.damping, 0.3 * share * rim_mass / dt)};
}

/// Deflects the bristles. Fresh, undeflected ones enter at the rolling speed.
void stretch(const scene::Wheel& tyre, const Vec2& slip, double rolling, double dt, Vec2& bristle) {
  bristle = (bristle + dt * slip) / (1 + dt * std::abs(rolling) / (kRelaxation * tyre.radius));
}

/// Returns the displacement d [m] by which soil yields until its mobilised strength equals the
/// force of the relaxing bristle: limit (1 - exp(-(j + d) / K)) = k (u - d). Newton's iterations
/// from below stay below, since the left side is concave; the start leaves at most a few K.
double yielding(const TrackShear& soil, double k, double stretched, double sheared) {
  double d = std::max(0.0, stretched - soil.limit / k);
  for (int i = 0; i < kYieldSteps; ++i) {
    const double left = std::exp(-(sheared + d) / soil.janosi_k);
    d += (k * (stretched - d) - soil.limit * (1 - left)) / (soil.limit / soil.janosi_k * left + k);
  }
  return std::clamp(d, 0.0, stretched);
}

}  // namespace

// Limits the deflection first, so that the bristle does not wind up while it slides.
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

// Lets the soil recover by rolling, then yield by the force that exceeds its strength.
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
