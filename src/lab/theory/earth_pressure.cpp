// SPDX-License-Identifier: Apache-2.0
#include "lab/theory/earth_pressure.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/math.h"

namespace navvy::lab {
namespace {

/// Smallest phi in c cot phi, from which pressures count, so that clay has a limit, too.
constexpr double kLeastPhi = 1e-5;

/// Returns the stress on the wall when the field turns by t.
WallStress turned_by(double t, double phi, double cohesion, double surcharge) {
  const double sine = std::sin(phi), tension = cohesion / std::tan(phi);
  const double p = (surcharge + tension) / (1 - sine) * std::exp(2 * t * std::tan(phi));
  return {p * (1 + sine * std::cos(2 * t)) - tension, p * sine * std::sin(2 * t)};
}

/// Returns force / (gamma H^2 / 2) along delta for a wall of height 1, with the pole at `away` from
/// the wall's head on Rankine's boundary. Uses moments of the body between wall, spiral and the
/// vertical section at the spiral's end.
double spiral_coefficient(double phi, double delta, double away) {
  // x ahead of the wall's head, z up.
  const double rise = kPi / 4 - phi / 2, px = -away * std::cos(rise), pz = away * std::sin(rise);
  const double radius = std::hypot(px, 1 + pz), toe = std::atan2(-1 - pz, -px), end = -rise;
  constexpr int kCorners = 800;
  // Of the body; first moment about the wall.
  double area = 0, moment = 0;
  // Start of the edge.
  double ax = 0, az = -1;
  const auto edge = [&](double bx, double bz) {
    const double cross = ax * bz - bx * az;
    area += 0.5 * cross, moment += cross * (ax + bx) / 6;
    ax = bx, az = bz;
  };
  for (int i = 1; i <= kCorners; ++i) {
    const double angle = toe + (end - toe) * i / kCorners,
                 r = radius * std::exp((angle - toe) * std::tan(phi));
    edge(px + r * std::cos(angle), pz + r * std::sin(angle));
  }
  const double depth = -az;
  // Rankine's zone begins at this section.
  edge(ax, 0);
  // Along the ground to the wall's head. The wall itself passes through the origin and adds no
  // area.
  edge(0, 0);
  const double rankine = 0.5 * rankine_passive(phi) * depth * depth;
  // Reactions along the spiral point at the pole and have no moment about it.
  const double resisting = moment - px * area + rankine * (pz + 2.0 / 3 * depth);
  // The wall pushes at its lower third, forwards and down.
  const double arm = (pz + 2.0 / 3) * std::cos(delta) + px * std::sin(delta);
  return arm > 0 && resisting > 0 ? 2 * resisting / arm : std::numeric_limits<double>::infinity();
}

}  // namespace

WallStress passive_slip_line(double phi, double delta, double cohesion, double adhesion,
                             double surcharge) {
  phi = std::max(phi, kLeastPhi);
  const auto excess = [&](double t) {
    const WallStress stress = turned_by(t, phi, cohesion, surcharge);
    return stress.shear - adhesion - stress.normal * std::tan(delta);
  };
  // The wall's share of friction grows with t until the wall is a slip line itself.
  double low = 0, high = kPi / 4 + phi / 2;
  if (excess(high) < 0) return turned_by(high, phi, cohesion, surcharge);
  for (int i = 0; i < 60; ++i) {
    const double t = 0.5 * (low + high);
    (excess(t) < 0 ? low : high) = t;
  }
  return turned_by(low, phi, cohesion, surcharge);
}

double passive_lancellotta(double phi, double delta) {
  const double sine = std::sin(phi), across = std::sin(delta);
  if (!(sine > 0)) return 1;
  const double turn = std::asin(std::min(1.0, across / sine)) + delta;
  return std::cos(delta) *
         (std::cos(delta) + std::sqrt(std::max(0.0, sine * sine - across * across))) / (1 - sine) *
         std::exp(turn * std::tan(phi));
}

double passive_log_spiral(double phi, double delta) {
  // Far away the spiral is a plane: a smooth wall's pole lies at infinity. There is one minimum; a
  // search by powers of ten brackets it.
  double best = std::numeric_limits<double>::infinity(), at = 0;
  for (double power = -3; power <= 3; power += 0.1) {
    const double value = spiral_coefficient(phi, delta, std::pow(10, power));
    if (value < best) best = value, at = power;
  }
  for (double power = at - 0.1; power <= at + 0.1; power += 0.005)
    best = std::min(best, spiral_coefficient(phi, delta, std::pow(10, power)));
  return best * std::cos(delta);
}

PassiveBand rough_passive(const BladeCase& blade) {
  const double delta = std::min(blade.delta, blade.phi);
  const double weight = 0.5 * blade.unit_weight * blade.depth * blade.depth;
  const WallStress rest =
      passive_slip_line(blade.phi, delta, blade.cohesion, blade.adhesion, blade.surcharge);
  PassiveBand out;
  const double lower = weight * passive_lancellotta(blade.phi, delta);
  out.low = blade.width * (lower + rest.normal * blade.depth);
  out.high =
      blade.width * (weight * passive_log_spiral(blade.phi, delta) + rest.normal * blade.depth);
  out.vertical = blade.width * (lower * std::tan(delta) + rest.shear * blade.depth);
  return out;
}

double matsuoka_nakai_triaxial(double phi) {
  const double square = std::sin(phi) * std::sin(phi), kappa = (9 - 3 * square) / (1 - square);
  // The larger root; the smaller is its inverse, extension.
  const double half = (kappa - 5) / 4, ratio = half + std::sqrt(std::max(0.0, half * half - 1));
  return std::asin((ratio - 1) / (ratio + 1));
}

}  // namespace navvy::lab
