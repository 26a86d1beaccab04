// SPDX-License-Identifier: Apache-2.0
#include "scene/soil_values.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/math.h"

namespace navvy::scene {
namespace {

std::string messages(const Soil& soil) {
  std::string out;
  for (const Fault& fault : check_soil(soil)) out += fault.text() + "\n";
  return out;
}

TEST(SoilValues, AcceptsTheDefaultSoilAndTheBounds) {
  EXPECT_EQ(messages({}), "");
  Soil soil;
  const std::vector<SoilValue> values = soil_values(soil);
  for (const SoilValue& v : values)
    for (const double bound : {v.low, v.high}) {
      soil = {};
      soil.cohesion = 1e6;  // above any residual
      *v.value = bound * v.factor;
      if (soil.residual_cohesion > soil.cohesion) soil.residual_cohesion = soil.cohesion;
      EXPECT_EQ(messages(soil), "") << v.name << " " << bound;
    }
}

TEST(SoilValues, ReportsValuesOutOfRangeWithSceneNameAndUnit) {
  Soil soil;
  soil.name = "mud";
  soil.friction_angle = radians(75);
  soil.poisson = std::nan("");
  soil.residual_cohesion = 2 * soil.cohesion;
  const std::string all = messages(soil);
  EXPECT_NE(all.find("soil[mud]/friction_angle_deg: '75': must be a number from 0 to 50"),
            std::string::npos)
      << all;
  EXPECT_NE(all.find("soil[mud]/poisson: 'nan'"), std::string::npos) << all;
  EXPECT_NE(all.find("soil[mud]/residual_cohesion_pa: '10000': must not exceed cohesion_pa, 5000"),
            std::string::npos)
      << all;
}

TEST(SoilValues, StiffnessFollowsTheCohesionByDefault) {
  EXPECT_EQ(Soil{}.young_modulus, default_stiffness(Soil{}.cohesion));
  EXPECT_EQ(default_stiffness(0), 1e6);
  EXPECT_EQ(default_stiffness(50e3), 10e6);
  Soil soil;
  soil.cohesion = 50e3;
  follow_cohesion(soil, Soil{}.cohesion);
  EXPECT_EQ(soil.young_modulus, 10e6);
  soil.young_modulus = 3e6;
  soil.cohesion = 80e3;
  follow_cohesion(soil, 50e3);
  EXPECT_EQ(soil.young_modulus, 3e6) << "its own";
}

TEST(SoilValues, LooseCohesionFollowsTheResidualOneByDefault) {
  EXPECT_EQ(Soil{}.loose_cohesion, default_loose_cohesion(Soil{}.residual_cohesion));
  Soil soil;
  soil.residual_cohesion = 1500;
  follow_residual_cohesion(soil, Soil{}.residual_cohesion);
  EXPECT_DOUBLE_EQ(soil.loose_cohesion, 300);
  soil.loose_cohesion = 700;
  soil.residual_cohesion = 2000;
  follow_residual_cohesion(soil, 1500);
  EXPECT_EQ(soil.loose_cohesion, 700) << "its own";
}

TEST(SoilValues, ReportsRequiredStiffnessAndCostOfSoilTooSoftForItsCohesion) {
  Soil clay;
  clay.name = "clay";
  clay.cohesion = 50e3;
  clay.young_modulus = 2.5e6;
  const auto warning = too_soft(clay);
  ASSERT_TRUE(warning);
  EXPECT_EQ(warning->severity, Fault::Severity::kWarning);
  const std::string text = warning->text();
  for (const char* part : {"soil[clay]/young_modulus_pa", "50 times the cohesion", "about 86 %",
                           "0.30 of its depth", "1e+07", "2.0 times as many steps"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  clay.young_modulus = 0.5e6;
  EXPECT_NE(too_soft(clay)->text().find("less than 63 %"), std::string::npos)
      << too_soft(clay)->text();
  clay.young_modulus = 5e6;
  EXPECT_FALSE(too_soft(clay));
  clay.cohesion = 0;
  EXPECT_FALSE(too_soft(clay)) << "sand";
}

}  // namespace
}  // namespace navvy::scene
