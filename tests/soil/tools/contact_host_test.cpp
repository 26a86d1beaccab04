// SPDX-License-Identifier: Apache-2.0
// The shares that nodes have in a contact: weights and areas, in doubles.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "soil/reference/double_contact.h"
#include "soil/tools/contact.h"

namespace navvy::soil {
namespace {

using reference::contact_area;
using reference::contact_weight;
using reference::ContactNode;
using reference::impulse_on;
using reference::Reach;

Reach shipped(double rate = 1) {
  const ContactSettings s;
  return {s.reach, s.ramp, s.edge, s.edge_ramp, rate, 1, s.opening};
}

/// Sum over the nodes of a lattice, `offset` cells aside, in front of a plate `length` x (wide) with two free edges.
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

TEST(ContactLaw, AreasOfNodesSumUpToThePlateWhereverItLies) {
  // Exact on a lattice along the plate's axes: hats and ramps as wide as a cell add up to one. Two edges must not share
  // a node: from 2 x 2.3 cells on.
  for (const double length : {5.0, 7.3, 12.0})
    for (const double offset : {0.0, 0.31, 0.5, 0.77})
      for (const double across : {0.0, 0.2, 0.5, 0.93})
        EXPECT_NEAR(area_of(length, offset, across), length, 1e-12) << length << " " << offset << " " << across;
}

TEST(ContactLaw, CornersAreMadeUpForByThePlatesFactor) {
  // 8 x 6 cells, nodes at any place: corners take an eighth of the area, the factor gives it back.
  const double cell = 0.1, length = 8, width = 6;
  scene::Shell plate;
  plate.vertices = {{0, 0, 0}, {0.1 * length, 0, 0}, {0.1 * length, 0.1 * width, 0}, {0, 0.1 * width, 0}};
  plate.triangles = {{0, 1, 2}, {0, 2, 3}};
  const double factor = plate_area_factor(ShellGeometry(plate, cell), ContactSettings{}, cell);
  EXPECT_GT(factor, 1.05);
  EXPECT_LT(factor, 1.3);
  const Reach r = shipped();
  double mean = 0;
  for (int place = 0; place < 100; ++place)
    for (double x = 0.1 * (place % 10) + 0.05; x < length; ++x)
      for (double y = 0.1 * (place / 10) + 0.05; y < width; ++y)
        mean += reference::contact_inner(std::min({x, length - x, y, width - y}), &r) / 100;
  EXPECT_NEAR(factor * mean / (length * width), 1, 0.01);
}

TEST(ContactLaw, ANodeThatHasAreaHasWeight) {
  // The shear that adhesion holds is divided by the weight.
  const Reach r = shipped(0.4);
  for (double clearance = -2; clearance <= 2; clearance += 0.01)
    for (double inset = 0; inset <= 3; inset += 0.05) {
      if (contact_area(clearance, inset, &r) <= 1e-6) continue;
      EXPECT_TRUE(contact_weight(clearance, inset, &r) > 0 || inset < r.edge) << clearance << " " << inset;
    }
}

TEST(ContactLaw, ShearIsAdhesionPlusCoulombUntilItSticks) {
  ContactNode node{Vec3(1, 0, -0.1), Vec3::Zero(), Vec3::UnitZ(), 2, 0.5, 0.4, 0.3};
  double opening = 0;
  const Vec3 sliding = impulse_on(node, opening);
  EXPECT_NEAR(sliding.z(), 0.5 * 0.2, 1e-12);
  EXPECT_NEAR(sliding.x(), -0.5 * (0.3 + 0.4 * 0.2), 1e-12);
  node.v = Vec3(0.1, 0, -0.1);
  EXPECT_NEAR(impulse_on(node, opening).x(), -0.5 * 2 * 0.1, 1e-12) << "sticks: no more than stops it";
  node.v = Vec3(1, 0, 0.1);
  opening = 0.05;
  EXPECT_EQ(impulse_on(node, opening), Vec3(Vec3::Zero())) << "no pull, and no shear once it lets go";
  node.v.z() = 0.04;
  EXPECT_NEAR(impulse_on(node, opening).x(), -0.5 * 0.3, 1e-12) << "adhesion needs no push";
  EXPECT_EQ(impulse_on(node, opening).z(), 0);
  node.v = Vec3(1, 0, -0.1);
  node.mu = node.stick = 0;
  EXPECT_EQ(impulse_on(node, opening).x(), 0) << "a smooth tool feels no shear";
}

}  // namespace
}  // namespace navvy::soil
