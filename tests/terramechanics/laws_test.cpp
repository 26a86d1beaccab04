// SPDX-License-Identifier: Apache-2.0
// Plate, shear and tyre patch compared with their closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "core/math.h"
#include "terramechanics/plate.h"
#include "terramechanics/shear.h"
#include "terramechanics/tyre_patch.h"

namespace navvy::terramechanics {
namespace {

TEST(Plate, PressureFollowsBekkersLaw) {
  scene::Soil soil;
  soil.bekker_kc = 1000, soil.bekker_kphi = 2e6, soil.bekker_n = 0.5;
  // (1000 / 0.25 + 2e6) sqrt(0.04): rounding only.
  EXPECT_NEAR(plate_pressure(soil, 0.04, 0.25), 2.004e6 * 0.2, 1e-6);
  EXPECT_EQ(plate_pressure(soil, 0, 0.25), 0);
  EXPECT_EQ(plate_pressure(soil, -0.1, 0.25), 0);
}

TEST(Plate, SinkageInvertsPressure) {
  const scene::Soil soil;
  for (const double width : {0.06, 0.28, 1.0})
    for (const double z : {1e-4, 0.05, 0.4})
      // Rounding only
      EXPECT_NEAR(plate_sinkage(soil, plate_pressure(soil, z, width), width), z, 1e-12);
}

TEST(Plate, DoesNotSinkWithoutPressureOrConstants) {
  scene::Soil soil;
  EXPECT_EQ(plate_sinkage(soil, 0, 0.28), 0);
  EXPECT_EQ(plate_sinkage(soil, -1e3, 0.28), 0);
  soil.bekker_kc = soil.bekker_kphi = 0;
  EXPECT_EQ(plate_sinkage(soil, 1e5, 0.28), 0);
}

TEST(Shear, MobilisesByJanosisLaw) {
  EXPECT_EQ(mobilised_share(0, 0.02), 0);
  EXPECT_NEAR(mobilised_share(0.02, 0.02), 1 - std::exp(-1.0), 1e-15);
  EXPECT_EQ(mobilised_share(-0.02, 0.02), mobilised_share(0.02, 0.02));
  // For large travel it is Coulomb's strength, opposite to the rim's slip.
  const ShearStrength strength{500, std::tan(radians(30))};
  EXPECT_NEAR(shear_stress(strength, 1e4, 10, 0.02), 500 + 1e4 * std::tan(radians(30)), 1e-9);
  EXPECT_NEAR(shear_stress(strength, 1e4, -10, 0.02), -(500 + 1e4 * std::tan(radians(30))), 1e-9);
}

TEST(Shear, RimSlidesIfItsFrictionIsLower) {
  scene::Soil soil;
  soil.friction_angle = radians(32), soil.residual_cohesion = 800;
  soil.tool_friction_angle = radians(20), soil.adhesion = 50;
  EXPECT_EQ(rim_strength(soil).cohesion, 50);
  EXPECT_EQ(rim_strength(soil).slope, std::tan(radians(20)));
  soil.tool_friction_angle = radians(35);
  EXPECT_EQ(rim_strength(soil).cohesion, 800);
  EXPECT_EQ(rim_strength(soil).slope, std::tan(radians(32)));
}

TEST(TyrePatch, EqualsTheChordOfItsDeflectionOnFirmGround) {
  scene::Soil rock;
  rock.bekker_kc = 0, rock.bekker_kphi = 1e15, rock.bekker_n = 1;
  scene::Wheel tyre;
  const TyrePatch patch = tyre_patch(tyre, rock, 30e3);
  const double half = std::sqrt(2 * tyre.radius * 30e3 / tyre.stiffness);
  EXPECT_LT(patch.sinkage, 1e-9);
  EXPECT_NEAR(patch.half_length, half, 1e-8);
  EXPECT_NEAR(patch.pressure, 30e3 / (2 * half * tyre.width), 1e-2);  // Pa, of 300 kPa
}

TEST(TyrePatch, CarriesTheLoadAtTheSinkageOfItsPressure) {
  const scene::Soil loam;
  scene::Wheel tyre;
  for (const double load : {5e3, 30e3, 80e3}) {
    const TyrePatch patch = tyre_patch(tyre, loam, load);
    const double length = chord_length(tyre.radius, patch.deflection + 0.5 * patch.sinkage);
    // Eight rounds that halve the error each leave 1 %.
    EXPECT_NEAR(patch.pressure * length * tyre.width, load, 0.01 * load);
    EXPECT_NEAR(plate_sinkage(loam, patch.pressure, tyre.width), patch.sinkage,
                0.01 * patch.sinkage);
    EXPECT_EQ(patch.tread_depth(0), patch.sinkage);
    EXPECT_NEAR(patch.tread_depth(patch.half_length), 0, 1e-12);
    EXPECT_EQ(patch.tread_depth(1.1 * patch.half_length), 0);
  }
}

TEST(TyrePatch, OfATwinPairEqualsThatOfEachTyre) {
  const scene::Soil loam;
  scene::Wheel single, pair;
  pair.twin_spacing = 0.32;
  pair.stiffness = 2 * single.stiffness;  // stiffness of the pair
  const TyrePatch one = tyre_patch(single, loam, 20e3), each = tyre_patch(pair, loam, 40e3);
  EXPECT_EQ(one.sinkage, each.sinkage);
  EXPECT_EQ(one.half_length, each.half_length);
}

TEST(TyrePatch, VanishesWithoutLoad) {
  EXPECT_EQ(tyre_patch({}, {}, 0).half_length, 0);
  EXPECT_EQ(tyre_patch({}, {}, -10).half_length, 0);
}

}  // namespace
}  // namespace navvy::terramechanics
