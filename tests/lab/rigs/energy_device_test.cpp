// SPDX-License-Identifier: Apache-2.0
// The soil's energy account [docs/soil.md, energy] balances and does not affect results.
#include <gtest/gtest.h>

#include "lab/run_rig.h"

namespace navvy::lab {
namespace {

Report with_energy(const std::string& rig, const std::map<std::string, double>& geometry) {
  return run_rig(rig, geometry, [](Setup& setup) { setup.energy = true; });
}

TEST(LabEnergy, OfABladeBalancesAndResultsAreBitIdentical) {
  const Report report = with_energy("blade", {});
  ASSERT_TRUE(report.energy);
  const soil::EnergyAccount& energy = *report.energy;
  // 2.5 kN over 0.07 m with their rise: 81 J.
  EXPECT_GT(energy.tools, 50);
  // All terms are computed independently: 0.4 % remains, as stresses and velocities are half a step
  // apart.
  EXPECT_NEAR(energy.residual(), 0, 0.015 * energy.tools);
  EXPECT_LE(energy.dissipated(), energy.supplied());
  for (const double spent :
       {energy.plastic, energy.viscous, energy.contact, energy.transfer, energy.mixing})
    EXPECT_GE(spent, 0);
  EXPECT_LE(energy.transfer, 0.05 * energy.tools);
  // The blade is smooth and compresses its soil: crowding gains less than a thousandth.
  EXPECT_NEAR(energy.apart, 0, 0.002 * energy.tools);
  EXPECT_EQ(report.state_hash, run_rig("blade", {}).state_hash);
  EXPECT_FALSE(run_rig("blade", {}).energy);
}

TEST(LabEnergy, OfAFallingBodyIsAbsorbedByTheSoil) {
  const Report report = with_energy("light-tool", {});
  ASSERT_TRUE(report.energy);
  const soil::EnergyAccount& energy = *report.energy;
  EXPECT_NEAR(energy.residual(), 0, 0.02 * energy.supplied());
  EXPECT_LT(energy.kinetic, 0.001 * energy.supplied()) << "at rest at the end";
  EXPECT_GT(energy.tools, 0) << "the body only loses energy to the soil";
}

}  // namespace
}  // namespace navvy::lab
