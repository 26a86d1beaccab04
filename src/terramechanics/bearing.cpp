// SPDX-License-Identifier: Apache-2.0
#include "terramechanics/bearing.h"

#include <algorithm>
#include <cmath>

#include "core/math.h"
#include "terramechanics/plate.h"

namespace navvy::terramechanics {
namespace {

// Share of c and tan phi in local shear [Terzaghi 1943].
constexpr double kLocal = 2.0 / 3;
constexpr int kSlices =
    // Slices of the arc ahead of a rim, an even number: within 0.5 % of the integral, 2 % near the
    // slip that ends bulldozing.
    8;
// Slices of the sunken segment of a side wall: within 0.1 % of the integral.
constexpr int kWallSlices = 32;
constexpr double kNoFriction = 1e-6;

}  // namespace

// Evaluates the formulas in the header, with their limits without friction.
BearingFactors BearingFactors::of(double tan_phi) {
  const double phi = std::atan(std::max(tan_phi, 0.0));
  const double a = std::exp((0.75 * kPi - 0.5 * phi) * tan_phi),
               lean = std::cos(0.25 * kPi + 0.5 * phi);
  BearingFactors out;
  out.q = a * a / (2 * lean * lean);
  out.c = tan_phi > kNoFriction ? (out.q - 1) / tan_phi : 1.5 * kPi + 1;
  out.gamma = 2 * (out.q + 1) * tan_phi / (1 + 0.4 * std::sin(4 * phi));
  return out;
}

// Interpolates between general and local shear by how far the soil has swollen.
double bearing_capacity(const SoilState& ground, double width, double depth) {
  if (ground.soil == nullptr) return 0;
  const double swell = ground.soil->swell;
  const double loose =
      swell > 1 ? std::clamp((ground.volume_ratio - 1) / (swell - 1), 0.0, 1.0) : 0.0;
  const double share = 1 - loose * (1 - kLocal);
  const ShearStrength strength = surface_strength(ground);
  const BearingFactors n = BearingFactors::of(share * strength.slope);
  const double weight = ground.density() * kGravity;
  return share * strength.cohesion * n.c + weight * std::max(depth, 0.0) * n.q +
         0.5 * weight * width * n.gamma;
}

// Flow up to a depth is the sinkage minus the part that the bearing capacity can compact.
double pushed_depth(const SoilState& ground, double width, double from, double to) {
  if (ground.soil == nullptr || !(to > from)) return 0;
  const auto flown = [&](double z) {
    return std::max(0.0,
                    z - plate_sinkage(*ground.soil, bearing_capacity(ground, width, z), width));
  };
  // With n < 1 the ground may support the plate again at a greater depth: soil that has flowed does
  // not return.
  return std::clamp(flown(to) - flown(from), 0.0, to - from);
}

namespace {

/// Passive pressure from cohesion [Pa], and its gradient with depth from weight [Pa/m].
struct PassivePressure {
  double cohesive = 0, by_depth = 0;
};

// Uses the factors of local shear, as the header explains.
PassivePressure passive_pressure(const SoilState& ground) {
  const ShearStrength strength = surface_strength(ground);
  const double tan_phi = kLocal * strength.slope, cos2 = 1 / (1 + tan_phi * tan_phi);
  const BearingFactors n = BearingFactors::of(tan_phi);
  const double k_c = (n.c - tan_phi) * cos2;
  // Limit without friction: 2 N / tan phi -> 4 (Nq + 1).
  const double k_gamma =
      ((tan_phi > kNoFriction ? 2 * n.gamma / tan_phi : 4 * (n.q + 1)) + 1) * cos2;
  return {kLocal * strength.cohesion * k_c, ground.density() * kGravity * k_gamma};
}

}  // namespace

double passive_resistance(const SoilState& ground, double width, double depth) {
  if (ground.soil == nullptr || !(depth > 0)) return 0;
  const PassivePressure p = passive_pressure(ground);
  return width * depth * (p.cohesive + 0.5 * depth * p.by_depth);
}

// A rim that stands or turns backwards mobilises all of the soil ahead.
double bulldozing(const SoilState& ground, double width, double radius, double depth,
                  double advance) {
  if (ground.soil == nullptr || !(depth > 0)) return 0;
  if (!(advance >= 0 && std::isfinite(advance))) return passive_resistance(ground, width, depth);
  // Soil at the surface is pushed farthest. A rim that slips over it pushes none at any depth.
  const double first = std::acos(std::clamp(1 - depth / radius, 0.0, 1.0));
  if (!(advance * first > std::sin(first))) return 0;
  const PassivePressure p = passive_pressure(ground);
  // Integrate over the arc by Simpson's rule, rotating sine and cosine from slice to slice. The
  // integrand is 0 below the axle.
  const double slice = first / kSlices, turn_cos = std::cos(slice), turn_sin = std::sin(slice);
  double at_cos = 1, at_sin = 0, sum = 0;
  for (int i = 1; i <= kSlices; ++i) {
    const double turned = at_cos * turn_cos - at_sin * turn_sin;
    at_sin = at_sin * turn_cos + at_cos * turn_sin;
    at_cos = turned;
    const double pushed = radius * (advance * i * slice - at_sin);
    if (!(pushed > 0)) continue;
    const double weight = i == kSlices ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
    const double resists = p.cohesive + (depth - radius * (1 - at_cos)) * p.by_depth;
    sum += weight * resists * mobilised_share(pushed, ground.soil->janosi_k) * at_sin;
  }
  return width * radius * slice / 3 * sum;
}

double side_wall_resistance(const SoilState& ground, double radius, double depth, double aside) {
  if (ground.soil == nullptr || !(depth > 0) || !(aside != 0)) return 0;
  const double half = std::sqrt(std::max(0.0, (2 * radius - depth) * depth));
  const double slice = 2 * half / kWallSlices;
  const PassivePressure p = passive_pressure(ground);
  double sum = 0;
  for (int i = 0; i < kWallSlices; ++i) {
    // From the front, where the soil meets the wall.
    const double passed = (i + 0.5) * slice, x = half - passed;
    const double z = std::sqrt(radius * radius - x * x) - (radius - depth);
    sum += z * (p.cohesive + 0.5 * z * p.by_depth) *
           mobilised_share(passed * aside, ground.soil->janosi_k);
  }
  return slice * sum;
}

}  // namespace navvy::terramechanics
