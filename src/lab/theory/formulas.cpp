// SPDX-License-Identifier: Apache-2.0
#include "lab/theory/formulas.h"

#include <algorithm>
#include <cmath>

#include "core/math.h"

namespace navvy::lab {
namespace {

double cot(double angle) { return 1 / std::tan(angle); }

/// Returns the position of the smallest value of f over (low, high) by golden section. f has one
/// minimum there.
template <class F>
double minimum_of(const F& f, double low, double high) {
  // Every iteration keeps one of the two inner points, so it costs one value of f.
  const double ratio = 0.5 * (std::sqrt(5.0) - 1);
  double a = high - ratio * (high - low), b = low + ratio * (high - low);
  double fa = f(a), fb = f(b);
  while (high - low > 1e-10) {
    if (fa < fb) {
      high = b, b = a, fb = fa;
      a = high - ratio * (high - low), fa = f(a);
    } else {
      low = a, a = b, fa = fb;
      b = low + ratio * (high - low), fb = f(b);
    }
  }
  return 0.5 * (low + high);
}

/// D of both models, the divisor in the wedge's equilibrium.
double divisor(const BladeCase& s, double beta) {
  return std::cos(s.rake + s.delta) + std::sin(s.rake + s.delta) * cot(beta + s.phi);
}

/// P of one rupture plane; its minimum over beta is the result.
double reece_force(const BladeCase& s, double beta) {
  const double d = divisor(s, beta), lean = cot(s.rake) + cot(beta), k = cot(beta + s.phi);
  // The four N of the header, each named by its factor.
  const double n_weight = lean / (2 * d), n_cohesion = (1 + cot(beta) * k) / d,
               n_adhesion = (1 - cot(s.rake) * k) / d, n_surcharge = lean / d;
  return s.width *
         (s.unit_weight * s.depth * s.depth * n_weight + s.cohesion * s.depth * n_cohesion +
          s.adhesion * s.depth * n_adhesion + s.surcharge * s.depth * n_surcharge);
}

double mckyes_force(const BladeCase& s, double beta) {
  const double d = divisor(s, beta), lean = cot(s.rake) + cot(beta), k = cot(beta + s.phi);
  // r is the distance ahead at which the wedge reaches the surface; crescents of that radius lie at
  // both sides.
  const double r = s.depth * lean, share = cot(s.rake) / lean,
               side = std::sqrt(std::max(0.0, 1 - share * share));
  const double n_weight = r / (2 * s.depth) * (1 + 2 * r / (3 * s.width) * side) / d;
  const double n_cohesion = (1 + cot(beta) * k) * (1 + r / s.width * side) / d;
  const double n_surcharge = r / s.depth * (1 + r / s.width * side) / d;
  return s.width * (s.unit_weight * s.depth * s.depth * n_weight +
                    s.cohesion * s.depth * n_cohesion + s.surcharge * s.depth * n_surcharge);
}

/// Equilibrium of a body of cross-section `area` between the blade and a plane at beta. Weight,
/// blade and rupture plane are the only forces, so the law of sines gives P.
double body_force(const BladeCase& s, double beta, double area) {
  return s.unit_weight * s.width * area * std::sin(beta + s.phi) /
         std::sin(s.rake + beta + s.delta + s.phi);
}

double riding_force(const BladeCase& s, double beta, double length) {
  // The layer turns at the edge. A parallelogram up the blade with a triangle at its foot rides on
  // it.
  const double thickness = s.depth * std::sin(s.rake + beta) / std::sin(beta);
  const double mean_length =
      length + s.depth + s.depth * std::cos(s.rake + beta) / (2 * std::sin(beta));
  return body_force(s, beta, thickness * mean_length);
}

/// Area between the blade, the plane at beta and the surface, in strips from the blade's upper edge
/// on [m2].
double area_over(const BladeCase& s, double beta, double height,
                 const std::function<double(double)>& surface) {
  // Behind the edge the blade bounds the body from below, ahead of it the rupture plane does.
  const double edge = -height * cot(s.rake), step = height / 400;
  double area = 0;
  for (double x = edge + 0.5 * step;; x += step) {
    const double high = surface(x) - (x < 0 ? -x * std::tan(s.rake) : x * std::tan(beta));
    // The wedge ends where the plane reaches the surface.
    if (x > 0 && high <= 0) return area;
    area += step * std::max(0.0, high);
  }
}

/// Returns the angle of the least force. Under an uneven pile there may be several minima: a scan
/// by degrees finds the lowest.
template <class F>
double lowest_angle(const F& force, double low, double high) {
  // A degree is finer than any minimum that a surface of cells makes.
  const double step = radians(1);
  double best = low;
  for (double beta = low; beta < high; beta += step)
    if (force(beta) < force(best)) best = beta;
  return minimum_of(force, std::max(low, best - step), std::min(high, best + step));
}

template <class F>
BladeForce least(const BladeCase& s, const F& force) {
  // The wedge exists while D > 0, that is for beta + phi + rake + delta < 180 degrees.
  const double high = kPi - s.phi - s.rake - s.delta;
  BladeForce out;
  out.beta =
      lowest_angle([&](double beta) { return force(s, beta); }, radians(2), high - radians(0.5));
  out.force = force(s, out.beta);
  // Adhesion acts along the blade and is not part of the resultant P; it is added here.
  out.horizontal =
      out.force * std::sin(s.rake + s.delta) + s.adhesion * s.depth * s.width * cot(s.rake);
  out.vertical = out.force * std::cos(s.rake + s.delta) - s.adhesion * s.depth * s.width;
  return out;
}

/// Slope of the plane on which a Rankine state slips: the square root of Kp.
double tan_45_plus_half(double phi) { return std::tan(kPi / 4 + phi / 2); }

}  // namespace

double rankine_active(double phi) { return (1 - std::sin(phi)) / (1 + std::sin(phi)); }
double rankine_passive(double phi) { return 1 / rankine_active(phi); }

double rankine_active_force(double phi, double cohesion, double unit_weight, double height) {
  const double ka = rankine_active(phi), crack = 2 * cohesion / (unit_weight * std::sqrt(ka));
  // The soil does not touch a wall lower than the crack.
  if (height <= crack) return 0;
  return 0.5 * unit_weight * height * height * ka - 2 * cohesion * height * std::sqrt(ka) +
         2 * cohesion * cohesion / unit_weight;
}

double rankine_passive_force(double phi, double cohesion, double unit_weight, double height) {
  const double kp = rankine_passive(phi);
  return 0.5 * unit_weight * height * height * kp + 2 * cohesion * height * std::sqrt(kp);
}

BladeForce reece_wedge(const BladeCase& blade) { return least(blade, reece_force); }
BladeForce mckyes_ali(const BladeCase& blade) { return least(blade, mckyes_force); }
BladeForce riding_layer(const BladeCase& blade, double length) {
  return least(blade,
               [length](const BladeCase& s, double beta) { return riding_force(s, beta, length); });
}
BladeForce wedge_under(const BladeCase& blade, double height,
                       const std::function<double(double)>& surface) {
  return least(blade, [&](const BladeCase& s, double beta) {
    return body_force(s, beta, area_over(s, beta, height, surface));
  });
}

double bearing_nq(double phi) {
  return std::exp(kPi * std::tan(phi)) * tan_45_plus_half(phi) * tan_45_plus_half(phi);
}
// The limit phi -> 0 is explicit: (Nq - 1) / tan phi is 0 / 0 there.
double bearing_nc(double phi) {
  return std::tan(phi) > 1e-9 ? (bearing_nq(phi) - 1) / std::tan(phi) : kPi + 2;
}
// Zero dilatancy reduces the strength of a mechanism that would have to dilate.
double davis_angle(double phi) { return std::atan(std::sin(phi)); }

// Both heights scale alike and differ in the mechanism of failure.
double cut_critical_height(double phi, double cohesion, double unit_weight) {
  return 3.83 * cohesion / unit_weight * tan_45_plus_half(phi);
}
double cut_no_tension_height(double phi, double cohesion, double unit_weight) {
  return 2 * cohesion / unit_weight * tan_45_plus_half(phi);
}

double lube_plane_run_out(double a) {
  // The paper leaves a gap between its two ranges; a line makes the law continuous at both ends.
  const auto high = [](double x) { return 1.9 * std::pow(x, 2.0 / 3); };
  if (a <= 1.8) return 1.2 * a;
  if (a >= 2.8) return high(a);
  return 1.2 * 1.8 + (high(2.8) - 1.2 * 1.8) * (a - 1.8);
}
double lube_axisymmetric_run_out(double a) { return a < 1.7 ? 1.24 * a : 1.6 * std::sqrt(a); }
double lajeunesse_axisymmetric_height(double a) { return std::min(a, 0.74); }
double lajeunesse_plane_height(double a) { return a < 0.7 ? a : std::cbrt(a); }
double lube_plane_height(double a) { return a < 1.15 ? a : std::pow(a, 0.4); }

double flow_angle(double phi) { return std::atan(std::sin(phi)); }

}  // namespace navvy::lab
