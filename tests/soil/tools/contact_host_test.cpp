// SPDX-License-Identifier: Apache-2.0
// Contact of a plate and a node: shares, areas, impulses, in doubles.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "soil/host_law/double_contact.h"
#include "soil/reference/impulse_on.h"
#include "soil/tools/contact.h"

namespace navvy::soil {
namespace {

using reference::contact_area;
using reference::contact_share;
using reference::ContactNode;
using reference::impulse_on;
using reference::Reach;

Reach shipped() {
  const SchemeConstants s;
  return {s.contact_reach,
          s.contact_ramp,
          s.contact_edge,
          s.contact_edge_ramp,
          1,
          s.contact_opening,
          s.contact_settling,
          s.contact_falling,
          s.edge_slow,
          0,
          0,
          -1};
}

/// Returns the sum over the nodes of a lattice, `offset` cells aside, in front of a plate `length`
/// x (wide) with two free edges.
double area_of(double length, double offset, double across) {
  const Reach r = shipped();
  double sum = 0;
  for (int k = -3; k <= 3; ++k)
    for (int i = -1; i <= static_cast<int>(length) + 1; ++i) {
      const double along = i + offset, inset = std::min(along, length - along);
      if (inset >= 0) sum += contact_area(k + across, inset, &r);
    }
  return sum;
}

TEST(ContactLaw, NodeAreasSumUpToThePlateWhereverItIs) {
  // Exact on a lattice along the plate's axes: hats and ramps of one cell add up to one. Two edges
  // must not share a node: from 2 x 2.3 cells on.
  for (const double length : {5.0, 7.3, 12.0})
    for (const double offset : {0.0, 0.31, 0.5, 0.77})
      for (const double across : {0.0, 0.2, 0.5, 0.93})
        EXPECT_NEAR(area_of(length, offset, across), length, 1e-12)
            << length << " " << offset << " " << across;
}

TEST(ContactLaw, CornersAreMadeUpForByThePlatesFactor) {
  // 8 x 6 cells, nodes at any place: corners take an eighth of the area, which the factor restores.
  const double cell = 0.1, length = 8, width = 6;
  scene::Shell plate;
  plate.vertices = {
      {0, 0, 0}, {0.1 * length, 0, 0}, {0.1 * length, 0.1 * width, 0}, {0, 0.1 * width, 0}};
  plate.triangles = {{0, 1, 2}, {0, 2, 3}};
  const double factor = plate_area_factor(ShellGeometry(plate, cell), cell);
  EXPECT_GT(factor, 1.05);
  EXPECT_LT(factor, 1.3);
  const Reach r = shipped();
  double mean = 0;
  for (int place = 0; place < 100; ++place) {
    const int column = place % 10, row = place / 10;
    for (double x = 0.1 * column + 0.05; x < length; ++x)
      for (double y = 0.1 * row + 0.05; y < width; ++y)
        mean += reference::contact_inner(std::min({x, length - x, y, width - y}), &r) / 100;
  }
  EXPECT_NEAR(factor * mean / (length * width), 1, 0.01);
}

TEST(ContactLaw, ANodeThatHasAreaHasAShare) {
  // Without a share there is no contact, and the shear of its area would be lost.
  const Reach r = shipped();
  for (double clearance = -2; clearance <= 2; clearance += 0.01)
    for (double inset = 0; inset <= 3; inset += 0.05) {
      if (contact_area(clearance, inset, &r) <= 1e-6) continue;
      EXPECT_GT(contact_share(clearance, inset, &r), 0) << clearance << " " << inset;
    }
}

TEST(ContactLaw, ShearIsAdhesionPlusCoulombUntilItSticks) {
  // A share changes nothing of it.
  ContactNode node{Vec3(1, 0, -0.1), Vec3::Zero(), Vec3::UnitZ(), 2, 0.5, 0, 0.4, 0.3, 0, 0};
  double opening = 0;
  const Vec3 sliding = impulse_on(node, opening);
  EXPECT_NEAR(sliding.z(), 0.2, 1e-12);
  EXPECT_NEAR(sliding.x(), -(0.3 + 0.4 * 0.2), 1e-12);
  node.v = Vec3(0.1, 0, -0.1);
  EXPECT_NEAR(impulse_on(node, opening).x(), -2 * 0.1, 1e-12) << "sticks: no more than stops it";
  node.v = Vec3(1, 0, 0.1);
  opening = 0.05;
  EXPECT_EQ(impulse_on(node, opening), Vec3(Vec3::Zero()))
      << "no pull, and no shear once it lets go";
  node.v.z() = 0.04;
  EXPECT_NEAR(impulse_on(node, opening).x(), -0.3, 1e-12) << "adhesion needs no push";
  EXPECT_EQ(impulse_on(node, opening).z(), 0);
  node.v = Vec3(1, 0, -0.1);
  node.mu = node.stick = 0;
  EXPECT_EQ(impulse_on(node, opening).x(), 0) << "a smooth tool feels no shear";
}

TEST(ContactLaw, ACoveredPartOfANodeKeepsUpWithItsShareOfAnAdvancingPlate) {
  // Four tenths covered, 2 kg, the plate advances at 0.5 m/s: soil faster than 0.2 m/s is not
  // affected.
  const Vec3 advance(0, 0, 0.5);
  ContactNode node{Vec3(0, 0, 0.2), Vec3::Zero(), Vec3::UnitZ(), 2, 0.4, 0, 0, 0, 0, 0};
  EXPECT_NEAR(impulse_on(node, 0, advance).z(), 0, 1e-15);
  node.v.z() = 0.1;
  EXPECT_NEAR(impulse_on(node, 0, advance).z(), 2 * 0.1, 1e-12)
      << "the whole mass, up to the share of the speed";
  node.share = 1;
  EXPECT_NEAR(impulse_on(node, 0, advance).z(), 2 * 0.4, 1e-12)
      << "covered whole: the plate's speed";
}

TEST(ContactLaw, APlateThatStandsOrRecedesHoldsItsLoadWholeWhateverTheShare) {
  ContactNode node{Vec3(0, 0, -0.3), Vec3::Zero(), Vec3::UnitZ(), 2, 0.01, 0, 0, 0, 0, 0};
  EXPECT_NEAR(impulse_on(node, 0).z(), 2 * 0.3, 1e-12);
  EXPECT_NEAR(impulse_on(node, 0, Vec3(0, 0, -0.2)).z(), 2 * 0.1, 1e-12);
  EXPECT_NEAR(impulse_on(node, 0, Vec3(0.7, 0, 0)).z(), 2 * 0.3, 1e-12) << "sideways is no advance";
}

TEST(ContactLaw, SoilAtTheEndOfTheReachSettlesTowardsAStandingPlateThatCarriesItsWholeLoad) {
  // The node keeps 0.02 m/s; the excess is taken from its whole mass, however slow.
  ContactNode node{Vec3(0, 0, -0.3), Vec3::Zero(), Vec3::UnitZ(), 2, 0.4, 0.02, 0, 0, 0, 0};
  EXPECT_NEAR(impulse_on(node, 0).z(), 2 * 0.28, 1e-12);
  node.v.z() = -0.02;
  EXPECT_NEAR(impulse_on(node, 0).z(), 0, 1e-15);
  EXPECT_NEAR(impulse_on(node, 0, Vec3(0, 0, 0.5)).z(), 2 * (0.2 + 0.02), 1e-12)
      << "a plate that advances: its share";
  const Reach r = shipped();
  for (const double down : {0.0, -1.0}) {
    EXPECT_EQ(reference::contact_settling(r.h - 0.5 * r.ramp, 0.02, down, &r), 0)
        << "soil at the plate stands";
    EXPECT_EQ(reference::contact_settling(r.h + 0.5 * r.ramp, 0, down, &r), r.settling);
    // It would take the soil's pressure off a plate that stands, and from under one that is slower
    // than the soil settles.
    EXPECT_NEAR(reference::contact_settling(r.h + 0.5 * r.ramp, 2.0 / 3, down, &r), 0, 1e-12)
        << "where there is no clearance";
  }
}

TEST(ContactLaw, AlmostEmptyNodesUnderAPlateDoNotSupportIt) {
  // A load in a bucket and soil before a blade are held for any fill of the node (above): they
  // would leak at their surface.
  const Reach r = shipped();
  const double at = r.h - 0.5 * r.ramp, end = r.h + 0.5 * r.ramp, both = r.settling + r.falling;
  EXPECT_EQ(reference::contact_settling(at, 2.0 / 3, 1, &r), 0)
      << "soil half as large again as in the bank";
  EXPECT_NEAR(reference::contact_settling(at, 0, 1, &r), both, 1e-12);
  EXPECT_NEAR(reference::contact_settling(end, 0.64, 1, &r), both, 1e-12);
  EXPECT_NEAR(reference::contact_settling(end, 0.91, 1, &r), 0, 1e-12)
      << "soil up to the plate: no clearance to settle into";
  EXPECT_LT(reference::contact_settling(at, 0.6, 1, &r), 0.02 * both)
      << "a plate settles slowly onto almost full nodes";
}

TEST(ContactLaw, FrictionOfAPartlyCoveredNodeIsThatOfItsPush) {
  const Vec3 advance(0, 0, 0.5);
  ContactNode node{Vec3(1, 0, 0.1), Vec3::Zero(), Vec3::UnitZ(), 2, 0.4, 0, 0.25, 0, 0, 0};
  const Vec3 impulse = impulse_on(node, 0, advance);
  EXPECT_NEAR(impulse.x(), -0.25 * impulse.z(), 1e-12);
  node.mu = 1e3;
  EXPECT_NEAR(impulse_on(node, 0, advance).x(), -2, 1e-12)
      << "the slip along the plate is stopped, not more";
}

TEST(ContactLaw, TheSlopeThatTheTwoWaySolveTakesIsThatOfTheImpulse) {
  // Across the branches: nodes covered whole and in part, sticking and sliding, plates that advance
  // and recede.
  const double step = 1e-6;
  for (const double share : {0.3, 1.0})
    for (const double speed : {0.4, -0.4})
      for (const double mu : {0.0, 1e3}) {
        const ContactNode node{
            Vec3(0.2, 0, -0.6), Vec3::Zero(), Vec3::UnitZ(), 2, share, 0, mu, 0, 0, 0};
        reference::ContactBranch branch;
        const auto at = [&](const Vec3& v) {
          return reference::contact_impulse(&node, Vec3::Zero(), v, 0, &branch);
        };
        const Vec3 plate(0, 0, speed);
        const Vec3 along = (at(plate + Vec3(step, 0, 0)) - at(plate)) / step;
        const Vec3 across = (at(plate + Vec3(0, 0, step)) - at(plate)) / step;
        EXPECT_NEAR(across.z(), node.m * branch.held, 1e-6) << share << " " << speed;
        EXPECT_NEAR(along.x(), branch.sticking ? node.m : 0.0, 1e-6) << share << " " << speed;
        EXPECT_EQ(branch.held, speed > 0 ? share : 1.0);
      }
}

}  // namespace
}  // namespace navvy::soil
