// SPDX-License-Identifier: Apache-2.0
#include "scene/friction.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <string>

namespace navvy::scene {
namespace {

using std::numbers::sqrt3;
constexpr double kRightAngle = kPi / 2;
// Conversions of the limit itself change its last bits.
constexpr double kRounding = 1e-9;

/// Returns the angle that triaxial compression mobilises. There q / p is that of the yield surface,
/// s1 = p + 2 q / sqrt(3) and s3 = p - q / sqrt(3).
double triaxial_angle(double phi, double psi) {
  const double sine = std::sin(phi);
  const double ratio =
      sine * yield_radius(sine, 2 / (3 * sqrt3)) * (1 + dilatant_match(sine, dilatancy_ratio(psi)));
  return std::asin(std::min(1.0, sqrt3 * ratio / (2 + ratio / sqrt3)));
}

/// Returns the phi that mobilises `angle` in triaxial compression, by bisection: the angle grows
/// with phi.
double plane_strain_of_triaxial(double angle, double psi) {
  // Without dilatancy, I1 I2 / I3 of both tests agree if tan angle = sqrt(3) / 2 tan phi.
  if (!(psi > 0)) return std::atan(2 / sqrt3 * std::tan(angle));
  double low = 0, high = kRightAngle;
  if (triaxial_angle(high, psi) < angle) return high;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (triaxial_angle(middle, psi) < angle ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

ValueAttribute friction_test_attribute(FrictionTest& test) {
  return {
      "test",
      Fields::choice_of<FrictionTest>(test, {std::begin(kFrictionTests), std::end(kFrictionTests)}),
      "Test that measured the angle; without it plane strain."};
}

double yield_radius(double sin_phi, double invariant) {
  const double a = 0.5 * sin_phi * (3 - sin_phi * sin_phi) * invariant;
  double r = 1;
  for (int newton = 0; newton < 10; ++newton)
    r -= ((a * r - 1) * r * r + 1) / ((3 * a * r - 2) * r);
  return r;
}

double dilatant_match(double sin_phi, double b) {
  // There s_zz = -2/3 b q, and the yield surface would be narrower by this radius.
  const double radius = yield_radius(sin_phi, -(2 * b / 3) * (1 - 4 * b * b / 9));
  const double cone = 1 / (std::sqrt(1 - b * b / 3) + b * sin_phi / 3);
  return cone / radius - 1;
}

double dilatancy_ratio(double psi) {
  const double sine = std::sin(psi);
  return sine / std::sqrt(1 + sine * sine / 3);
}

double angle_in_test(FrictionTest test, double phi, double psi) {
  const double sine = std::sin(phi);
  switch (test) {
    case FrictionTest::kDirectShear:
      // The plane of the box does not change its length, and stress and strain rate are coaxial.
      return std::atan2(sine * std::cos(psi), 1 - sine * std::sin(psi));
    case FrictionTest::kTriaxial:
      return triaxial_angle(phi, psi);
    case FrictionTest::kRepose:
      return std::atan(sine);
    case FrictionTest::kPlaneStrain:
      break;
  }
  return phi;
}

double plane_strain_angle(FrictionTest test, double angle, double psi) {
  const double slope = std::tan(angle);
  switch (test) {
    case FrictionTest::kDirectShear:
      return std::asin(std::min(1.0, slope / (std::cos(psi) + slope * std::sin(psi))));
    case FrictionTest::kTriaxial:
      return plane_strain_of_triaxial(angle, psi);
    case FrictionTest::kRepose:
      return std::asin(std::min(1.0, slope));
    case FrictionTest::kPlaneStrain:
      break;
  }
  return angle;
}

std::optional<Fault> check_friction(FrictionTest test, double angle, double psi) {
  const double most = kMostFrictionDegrees * kDegree;
  if (plane_strain_angle(test, angle, psi) <= most + kRounding) return std::nullopt;
  Fault out;
  out.value = short_text(angle / kDegree);
  const std::string limit = short_text(kMostFrictionDegrees) + " deg in plane strain";
  out.rule = "must be at most " + limit;
  if (test != FrictionTest::kPlaneStrain)
    out.rule = std::string("is above the limit of ") + limit + ", which measures " +
               short_text(angle_in_test(test, most, psi) / kDegree, 3) + " deg in a test of type " +
               name_of(test);
  out.remedy = "check the angle and its test; strength beyond friction is cohesion_pa";
  return out;
}

}  // namespace navvy::scene
