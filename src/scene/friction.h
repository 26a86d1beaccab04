// SPDX-License-Identifier: Apache-2.0
// Friction angles of different soil tests, and their conversion to the plane-strain angle phi that
// the constitutive law uses [docs/soil.md, friction angles].
#pragma once

#include <cstddef>
#include <optional>
#include <utility>

#include "core/error.h"
#include "scene/fields.h"

namespace navvy::scene {

/// Test that measured a friction angle.
enum class FrictionTest {
  kPlaneStrain,  ///< biaxial test: the law's own phi
  kDirectShear,  ///< shear box or ring: tan of the angle is shear / normal stress of the plane
  kTriaxial,     ///< triaxial compression
  kRepose,       ///< slope of a poured heap, on which loose soil comes to rest without dilatancy
};
/// Every test with its name in files, in the order of FrictionTest; the first is the default.
inline constexpr std::pair<const char*, FrictionTest> kFrictionTests[] = {
    {"plane_strain", FrictionTest::kPlaneStrain},
    {"direct_shear", FrictionTest::kDirectShear},
    {"triaxial", FrictionTest::kTriaxial},
    {"repose", FrictionTest::kRepose}};
/// Returns the name of a test in files.
constexpr const char* name_of(FrictionTest test) {
  return kFrictionTests[static_cast<std::size_t>(test)].first;
}
/// Returns the attribute `test` of a friction angle, which is stored in `test`.
ValueAttribute friction_test_attribute(FrictionTest& test);
/// Largest plane-strain friction angle that a soil may have, in degrees.
inline constexpr double kMostFrictionDegrees = 50;

/// Returns the radius of the yield surface, in the direction of a deviatoric stress s, divided by
/// its radius in plane strain [docs/soil.md, yield].
/// @param invariant -(det s) / q^3 of that stress, with q = sqrt(s : s / 2); 2 / sqrt(27) in
/// triaxial compression
double yield_radius(double sin_phi, double invariant);

/// Returns the factor by which the yield surface of dense soil that dilates by `b` is enlarged, so
/// that phi remains its angle in plane strain [docs/soil.md, dilatancy].
/// @param b plastic volume strain / plastic shear strain
double dilatant_match(double sin_phi, double b);

/// Returns b, the plastic volume strain / plastic shear strain in plane strain, of the dilatancy
/// angle `psi` [rad].
double dilatancy_ratio(double psi);

/// Returns the friction angle [rad] that `test` measures on a soil with the plane-strain angle
/// `phi` and the dilatancy angle `psi` [rad] in the bank state.
double angle_in_test(FrictionTest test, double phi, double psi);

/// Returns the plane-strain angle phi [rad] of a soil on which `test` measured `angle` [rad]; the
/// inverse of angle_in_test. Returns 90 degrees if no soil measures so much.
double plane_strain_angle(FrictionTest test, double angle, double psi);

/// Returns a fault if the plane-strain angle of a measured `angle` [rad] is above the limit of
/// kMostFrictionDegrees, otherwise nothing. The fault has value, rule and remedy only.
std::optional<Fault> check_friction(FrictionTest test, double angle, double psi);

}  // namespace navvy::scene
