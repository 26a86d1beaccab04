// SPDX-License-Identifier: Apache-2.0
// Resistance of soil on the edges of plates and on teeth, small and coarse; `navvy lab tip`
// measures it in detail.
#include <gtest/gtest.h>

#include "lab/theory/formulas.h"
#include "lab/tool_driver.h"
#include "log_lines.h"
#include "soil/host_law/double_contact.h"
#include "soil/rig.h"
#include "soil/tools/edge.h"

namespace navvy::soil {
namespace {

using rig::Rig;
using rig::SiteBox;

/// Soil without weight on tools: only edges resist.
scene::Soil clay() {
  scene::Soil soil = lab::without_tool_friction(lab::cohesive(0, 10e3));
  soil.young_modulus = 2e6;
  return soil;
}

constexpr double kWidth = 0.6, kDepth = 0.25;

/// An upright plate of 30 mm with sharp sides below the ground's surface: only its lower edge cuts.
scene::Shell upright() {
  scene::Shell shell = lab::blade(kWidth, 0.6);
  shell.half_thickness = 0.015;
  shell.edge_share = 1;
  return shell;
}

/// Mean forces at the end of a push, and after a hold [N].
struct Push {
  Vec3 force, edge, held;
  double residual = 0;
};

/// Pushes a plate 0.25 m straight down into level ground and holds it for `hold` seconds.
Push push(const scene::Shell& shell, const scene::Soil& soil, double hold = 0) {
  const SiteBox bed{Vec3(-0.4, -0.6, -0.6), Vec3(0.4, 0.6, 0)};
  Rig rig({soil}, bed, 0.1, 40, Vec2(-2, -2));
  rig.solver().insert(rig.fill(bed, true));
  lab::ToolDriver driver(rig, shell, make_pose(0.013, 0.007, 0.02));
  driver.advance(0.9 * kDepth, Vec3(0, 0, -0.2));
  const std::size_t from = driver.trace().force.size();
  driver.advance(0.1 * kDepth + 0.02, Vec3(0, 0, -0.2));
  Push out{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), 0};
  const auto count = static_cast<double>(driver.trace().force.size() - from);
  for (std::size_t i = from; i < driver.trace().force.size(); ++i) {
    out.force += driver.trace().force[i] / count;
    out.edge += driver.trace().edge[i] / count;
  }
  if (hold > 0) {
    driver.set_twist(Vec3::Zero());
    driver.run(hold - 0.2);
    out.held = driver.run(0.2);
  }
  out.residual = rig.worst_residual();
  return out;
}

TEST(Edge, FactorsAreThoseOfAStripAndOfAWedge) {
  // The double of a float: 1e-6 of the value.
  for (const double degree : {0.0, 20.0, 30.0, 45.0}) {
    const double phi = radians(degree);
    const EdgeFactors f = edge_factors(phi, kPi);
    EXPECT_NEAR(f.flat_c, lab::bearing_nc(phi), 2e-6 * f.flat_c);
    EXPECT_NEAR(f.flat_q, lab::bearing_nq(phi), 2e-6 * f.flat_q);
    EXPECT_EQ(f.wedge_c, f.flat_c);
    EXPECT_EQ(f.wedge_q, f.flat_q);
  }
  // A smooth wedge of 60 deg in clay: p = 2 c (1 + pi / 6).
  EXPECT_NEAR(edge_factors(0, radians(60)).wedge_c, 2 + kPi / 3, 1e-6);
}

TEST(Edge, BevelReducesTheResistanceUnlessItsFacesAreRough) {
  const EdgeFactors f = edge_factors(radians(30), radians(40));
  const double smooth = reference::edge_factor(f.flat_q, f.wedge_q, 0);
  EXPECT_LT(smooth, 0.5 * f.flat_q);
  EXPECT_GT(reference::edge_factor(f.flat_q, f.wedge_q, 0.3), smooth);
  // However sharp and rough, never more than a blunt edge.
  EXPECT_EQ(reference::edge_factor(f.flat_q, f.wedge_q, 1e9), f.flat_q);
}

TEST(Edge, ActsWhereAPlateAdvancesInItsPlaneOrStands) {
  EXPECT_EQ(reference::edge_share(0.2, 0.2, 0.01), 1);
  EXPECT_EQ(reference::edge_share(0, 0, 0.01), 1);
  EXPECT_EQ(reference::edge_share(-0.2, 0.2, 0.01), 0);
  EXPECT_NEAR(reference::edge_share(0, 0.2, 0.01), 0.01 / 0.21, 1e-12);
}

TEST(Edge, ImpulseStopsTheApproachUpToTheResistance) {
  reference::ContactNode node{Vec3(0.3, 0, 0.1), Vec3::Zero(), -Vec3::UnitZ(), 2, 0, 0, 0, 0, 0, 0};
  node.slow = 0.01;
  reference::ContactBranch branch;
  const auto impulse = [&](double speed) {
    return reference::contact_impulse(&node, Vec3::Zero(), Vec3(0, 0, -speed), 0, &branch);
  };
  node.edge = 1;
  // Needs 2 kg x (0.2 + 0.1) m/s; nothing acts across the edge's direction.
  EXPECT_NEAR((impulse(0.2) - Vec3(0, 0, -0.6)).norm(), 0, 1e-12);
  EXPECT_EQ(branch.held, 1);
  node.edge = 0.5;
  EXPECT_NEAR((impulse(0.2) - Vec3(0, 0, -0.5)).norm(), 0, 1e-12);
  EXPECT_EQ(branch.held, 0);
  // A plate that stands still carries soil that rises.
  EXPECT_NEAR((impulse(0) - Vec3(0, 0, -0.2)).norm(), 0, 1e-12);
  // It never pulls.
  node.v = Vec3(0, 0, -0.4);
  EXPECT_EQ(impulse(0.2).norm(), 0);
  EXPECT_FALSE(branch.acts);
}

TEST(Edge, PlateFeelsTheBearingResistanceAndKeepsItWhenItStops) {
  const Push got = push(upright(), clay(), 1.5);
  const double z = kDepth - 0.05 * kDepth,
               expected = (10e3 * lab::bearing_nc(0) + 1600 * kGravity * z) * 0.03 * kWidth;
  print_value("force on a plate of 30 mm / bearing capacity", got.force.z() / expected,
              "0.75 to 1.25", "[docs/tools.md, edges]");
  print_value("held / in motion", got.held.z() / got.force.z(), "at least 0.8",
              "[docs/tools.md, edges]");
  EXPECT_GT(got.force.z(), 0.75 * expected);
  EXPECT_LT(got.force.z(), 1.25 * expected);
  EXPECT_GT(got.edge.z(), 0.75 * got.force.z());
  EXPECT_GT(got.held.z(), 0.8 * got.force.z());
  // Rounding only.
  EXPECT_LT(got.residual, 1e-5);
}

TEST(Edge, SharpPlateFeelsNothing) {
  scene::Shell shell = upright();
  shell.edge_share = 0;
  const Push got = push(shell, clay());
  EXPECT_EQ(got.edge.norm(), 0);
}

TEST(Edge, OnlyTheCuttingEdgeOfABucketResists) {
  scene::Shell shell = upright();
  const double whole = push(shell, clay()).edge.z();
  // A straight edge, as scene::Machine::with_teeth gives it to a bucket without teeth.
  shell.toothed = scene::ToothedEdge{{1, kWidth, 0, kPi}, Vec3::Zero(), -Vec3::UnitZ(), kWidth};
  EXPECT_NEAR(push(shell, clay()).edge.z() / whole, 1, 0.01);
  // The edge that is pushed into the ground is a rim of a bucket that cuts the other way.
  shell.toothed->ahead = Vec3::UnitZ();
  const LogLines log;
  EXPECT_EQ(push(shell, clay()).edge.norm(), 0);
  EXPECT_NE(log.text().find("its cutting edge meets no resistance"), std::string::npos)
      << log.text();
}

TEST(Edge, TeethResistByTheirShareOfTheEdge) {
  scene::Shell shell = upright();
  shell.toothed = scene::ToothedEdge{{3, 0.08, 0, kPi}, Vec3::Zero(), -Vec3::UnitZ(), kWidth};
  const double whole = push(upright(), clay()).edge.z(), teeth = push(shell, clay()).edge.z();
  print_value("force on teeth / on the whole edge", teeth / whole, "0.4", "3 x 80 of 600 mm");
  EXPECT_NEAR(teeth / whole, 0.4, 0.04);
}

}  // namespace
}  // namespace navvy::soil
