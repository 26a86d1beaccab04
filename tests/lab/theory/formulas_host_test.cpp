// SPDX-License-Identifier: Apache-2.0
// Closed forms compared with independently computed values.
#include "lab/theory/formulas.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "core/math.h"
#include "lab/rig.h"
#include "lab/soils.h"
#include "lab/tool_driver.h"

namespace navvy::lab {
namespace {

TEST(Formulas, RankineMatchesItsTable) {
  // Coefficients of any textbook, to three digits [Terzaghi 1943].
  EXPECT_NEAR(rankine_active(radians(30)), 0.333, 5e-4);
  EXPECT_NEAR(rankine_active(radians(35)), 0.271, 5e-4);
  EXPECT_NEAR(rankine_active(radians(40)), 0.217, 5e-4);
  EXPECT_NEAR(rankine_passive(radians(30)), 3.00, 5e-3);
  EXPECT_NEAR(rankine_passive(radians(35)), 3.69, 5e-3);
  EXPECT_NEAR(rankine_passive(radians(40)), 4.60, 5e-3);
}

TEST(Formulas, ActiveForceOfCohesiveSoilBeginsBelowTheCrack) {
  const double phi = radians(30), c = 5000, gamma = 18000;
  const double crack = cut_no_tension_height(phi, c, gamma);
  EXPECT_EQ(rankine_active_force(phi, c, gamma, 0.99 * crack), 0);
  // Below the crack the pressure is a triangle that starts at zero.
  const double h = 2.5;
  EXPECT_NEAR(rankine_active_force(phi, c, gamma, h),
              0.5 * gamma * rankine_active(phi) * std::pow(h - crack, 2), 1e-6);
}

TEST(Formulas, WedgeReproducesItsCheckValue) {
  BladeCase blade;
  blade.phi = radians(35);
  blade.delta = radians(20);
  blade.rake = radians(60);
  blade.depth = 0.5;
  blade.unit_weight = 1800 * kGravity;
  const BladeForce got = reece_wedge(blade);
  // Computed by hand to these digits.
  EXPECT_NEAR(degrees(got.beta), 28.11, 0.005);
  EXPECT_NEAR(got.force, 8032.7, 0.05);
}

TEST(Formulas, SmoothUprightWedgeMatchesRankine) {
  BladeCase blade;
  blade.phi = radians(35);
  blade.rake = radians(90);
  blade.depth = 0.3;
  blade.unit_weight = 16000;
  blade.cohesion = 2000;
  EXPECT_NEAR(reece_wedge(blade).horizontal, rankine_passive_force(blade.phi, 2000, 16000, 0.3),
              1e-3);
  EXPECT_NEAR(degrees(reece_wedge(blade).beta), 45 - 17.5, 1e-3);
}

TEST(Formulas, NarrowBladeTendsToTheWedgeWhenWide) {
  BladeCase blade;
  blade.phi = radians(38);
  blade.delta = radians(26.6);
  blade.rake = radians(45);
  blade.depth = 0.1;
  blade.width = 1000;
  blade.unit_weight = 1460 * kGravity;
  EXPECT_NEAR(mckyes_ali(blade).force / reece_wedge(blade).force, 1, 1e-3);
  blade.width = 0.33;
  EXPECT_GT(mckyes_ali(blade).force, 1.1 * reece_wedge(blade).force);
}

BladeCase dry_sand_cut(double rake_degrees, double depth) {
  BladeCase blade;
  blade.phi = radians(38);
  blade.delta = radians(26.6);
  blade.rake = radians(rake_degrees);
  blade.depth = depth;
  blade.width = 0.33;
  blade.unit_weight = 1460 * kGravity;
  return blade;
}

TEST(Formulas, RidingLayerReproducesTheNineValuesOfItsTable) {
  const double rakes[] = {30, 45, 60}, depths[] = {0.05, 0.10, 0.15};
  // [Miedema 2014], blade 0.20 m
  const double forces[3][3] = {{104, 259, 463}, {163, 400, 711}, {250, 605, 1064}};
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k)
      // Printed to 1 N, and with 0.3 N of inertia.
      EXPECT_NEAR(riding_layer(dry_sand_cut(rakes[i], depths[k]), 0.2).horizontal, forces[i][k],
                  0.8);
}

TEST(Formulas, WedgeUnderLevelGroundMatchesReeceAndGrowsWithThePile) {
  const BladeCase blade = dry_sand_cut(60, 0.1);
  const double level = reece_wedge(blade).horizontal;
  // Strips 0.25 mm wide.
  EXPECT_NEAR(wedge_under(blade, 0.1, [](double) { return 0.1; }).horizontal / level, 1, 0.01);
  EXPECT_GT(wedge_under(blade, 0.173, [](double x) { return x < 0.1 ? 0.173 : 0.1; }).horizontal,
            1.3 * level);
}

TEST(Formulas, BearingCapacityMatchesItsTable) {
  EXPECT_NEAR(bearing_nc(0), 5.14, 5e-3);
  EXPECT_NEAR(bearing_nq(radians(20)), 6.40, 5e-3);
  EXPECT_NEAR(bearing_nq(radians(30)), 18.40, 5e-3);
  EXPECT_NEAR(bearing_nq(davis_angle(radians(20))), 5.73, 5e-3);
  EXPECT_NEAR(bearing_nq(davis_angle(radians(30))), 12.6, 5e-2);
}

TEST(Formulas, CutHeightsMatchTheirExample) {
  EXPECT_NEAR(cut_critical_height(radians(30), 5000, 18000), 1.84, 5e-3);
  EXPECT_NEAR(cut_no_tension_height(radians(30), 5000, 18000), 0.96, 5e-3);
}

TEST(Formulas, CollapseLawsAndFlowAnglesMatchTheirTables) {
  EXPECT_NEAR(lube_plane_run_out(1), 1.2, 1e-12);
  EXPECT_NEAR(lube_plane_run_out(5), 1.9 * std::pow(5, 2.0 / 3), 1e-12);
  EXPECT_NEAR(lube_axisymmetric_run_out(1), 1.24, 1e-12);
  EXPECT_NEAR(lube_axisymmetric_run_out(3), 1.6 * std::sqrt(3), 1e-12);
  EXPECT_EQ(lajeunesse_axisymmetric_height(0.5), 0.5);
  EXPECT_EQ(lajeunesse_axisymmetric_height(3), 0.74);
  EXPECT_EQ(lajeunesse_plane_height(0.5), 0.5);
  EXPECT_NEAR(lajeunesse_plane_height(8), 2, 1e-12);
  EXPECT_EQ(lube_plane_height(1), 1);
  EXPECT_NEAR(lube_plane_height(32), 4, 1e-12);
  const double phi[] = {25, 30, 35, 40}, flows[] = {22.9, 26.6, 29.8, 32.7};
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(degrees(flow_angle(radians(phi[i]))), flows[i], 0.05);
}

TEST(Trace, MeansOverTravelAndLowPassKeepAConstant) {
  Trace trace;
  for (int i = 0; i < 100; ++i) {
    trace.time.push_back(0.01 * i);
    trace.travel.push_back(0.02 * i);
    trace.force.push_back(Vec3(i < 50 ? 1 : 3, 0, i % 2 == 0 ? 1 : -1));
  }
  EXPECT_NEAR(mean_force(trace, 1.0, 2.0).x(), 3, 1e-12);
  EXPECT_NEAR(force_scatter(trace, 1.0, 2.0).z(), 1, 1e-12);
  EXPECT_TRUE(std::isnan(mean_force(trace, 5, 6).x()));
  const std::vector<double> flat = low_pass(trace.time, std::vector<double>(100, 7.0), 5);
  for (const double v : flat) EXPECT_NEAR(v, 7, 1e-12);
}

}  // namespace
}  // namespace navvy::lab
