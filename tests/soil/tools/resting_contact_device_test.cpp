// SPDX-License-Identifier: Apache-2.0
// A tool that stands: its soil becomes columns, which support it until the load grows.
#include <gtest/gtest.h>

#include <cmath>

#include "lab/rig_shapes.h"
#include "soil/rig.h"
#include "soil/tools/resting_contact.h"

namespace navvy::soil {
namespace {

// 8 kPa on ground of 5 kPa.
constexpr double kMass = 300, kHeight = 0.3;

scene::Soil ground_of(double tool_friction_degrees) {
  scene::Soil out = lab::cohesive(28, 5000);
  out.tool_friction_angle = radians(tool_friction_degrees);
  return out;
}

/// A site whose ground exchanges soil with particles, with a box on it.
class RestingBody : public lab::Site {
 public:
  RestingBody() : RestingBody(0, lab::cohesive(28, 5000)) {}
  /// Makes ground that rises along x by `slope` [rad].
  RestingBody(double slope, const scene::Soil& soil)
      : Site(rig::Rig::device(), {soil}, 0.1, options(slope)) {
    scene::Shell shell = lab::closed_box(0.6, 0.6, kHeight);
    for (Vec3& v : shell.vertices) v.z() -= kHeight / 2;
    const double under = kHeight / 2 + 0.05;
    box_ = add_tool(shell, make_pose(0.02 - under * std::sin(slope), 0.01,
                                     0.02 * std::tan(slope) + under * std::cos(slope), 0, -slope));
    box().mass = kMass;
    box().inertia = kMass / 12 * Vec3(0.45, 0.45, 0.72);
  }
  lab::Tool& box() { return tool(box_); }
  double height() { return box().motion.X_WT.translation().z(); }
  int active() const { return solver().stats().particles; }
  /// Runs until no particle is left; returns false when some are after 15 s.
  bool come_to_rest() {
    for (int i = 0; i < 30; ++i) {
      run(0.5);
      if (active() == 0) return true;
    }
    return false;
  }

 private:
  static lab::SiteOptions options(double slope) {
    lab::SiteOptions out;
    if (slope > 0) out.surface = [slope](double x, double) { return x * std::tan(slope); };
    out.size = 4;
    out.depth = 1;
    out.exchange = true;
    return out;
  }
  int box_ = 0;
};

TEST(RestingContact, AStandingBodyIsSupportedByColumnsAndDoesNotMove) {
  RestingBody site;
  ASSERT_TRUE(site.come_to_rest());
  const double before = site.height();
  site.run(2);
  EXPECT_EQ(site.active(), 0);
  EXPECT_NEAR(site.height(), before, 1e-9) << "[m] in 2 s";
  EXPECT_NEAR(site.box().impulse.force_W.z() / (kMass * kGravity), 1, 1e-6);
  EXPECT_EQ(site.solver().ledger().error(), 0);
}

TEST(RestingContact, AboveItsPreviousLoadTheGroundActivatesAndSupportsAnew) {
  RestingBody site;
  ASSERT_TRUE(site.come_to_rest());
  const double before = site.height();
  site.box().force_W = Vec3(0, 0, -2 * kMass * kGravity);
  site.run(0.5);
  EXPECT_GT(site.active(), 0);
  ASSERT_TRUE(site.come_to_rest());
  EXPECT_LT(site.height(), before + 1e-3);
  EXPECT_GT(site.height(), before - 0.1) << "a cell";
  EXPECT_NEAR(site.box().impulse.force_W.z() / (3 * kMass * kGravity), 1, 1e-6);
  EXPECT_EQ(site.solver().ledger().error(), 0);
}

TEST(RestingContact, IsLeftByABodyThatIsLiftedOrPushedAside) {
  for (const Vec3& push :
       {Vec3(0, 0, 1.5 * kMass * kGravity), Vec3(0.8 * kMass * kGravity, 0, 0)}) {
    RestingBody site;
    ASSERT_TRUE(site.come_to_rest());
    const Vec3 before = site.box().motion.X_WT.translation();
    site.box().force_W = push;
    site.run(0.3);
    // Half of its displacement without any ground is more than friction of 20 degrees removes.
    EXPECT_GT((site.box().motion.X_WT.translation() - before).norm(), 0.05) << push;
    EXPECT_EQ(site.solver().ledger().error(), 0);
  }
}

TEST(RestingContact, GoesOnFromASnapshotAsIfNothingHappened) {
  RestingBody site, other;
  ASSERT_TRUE(site.come_to_rest());
  const std::vector<char> ground = saved(site.ground()), soil = saved(site.solver());
  load_saved(ground, other.ground());
  load_saved(soil, other.solver());
  other.box().motion = site.box().motion;
  for (RestingBody* each : {&site, &other}) {
    each->run(0.5);
    each->box().force_W = Vec3(0, 0, -2 * kMass * kGravity);
    each->run(0.5);
  }
  EXPECT_GT(site.active(), 0);
  EXPECT_EQ(site.digest(), other.digest());
  EXPECT_EQ(site.height(), other.height());
}

TEST(RestingContact, StartsOnlyWhereTheFeetCarryTheLoad) {
  const scene::Shell box = lab::closed_box(0.6, 0.6, 0.3);
  ToolMotion motion;
  motion.inverse_mass = Mat6::Identity();
  EXPECT_EQ(contact_vertices(box, motion.X_WT, 0.1, Vec3::UnitZ()).size(), 4u);
  const auto takes = [&](const Vec3& force, const Vec3& moment) {
    RestingContact contact;
    contact.start(box, motion, force, moment, 0.36, 0.1, Vec3::UnitZ());
    return contact.engaged;
  };
  EXPECT_TRUE(takes(Vec3(0, 0, 1000), Vec3::Zero()));
  EXPECT_TRUE(takes(Vec3(300, 0, 1000), Vec3::Zero())) << "by friction";
  EXPECT_FALSE(takes(Vec3(500, 0, 1000), Vec3::Zero()));
  EXPECT_FALSE(takes(Vec3(0, 0, 1000), Vec3(0, -400, 0))) << "0.4 m aside, where no vertex is";
}

TEST(RestingContact, ABodyOnASlopeBelowItsFrictionAngleStandsOnColumns) {
  for (const double degrees : {5.0, 12.0}) {
    RestingBody site(radians(degrees), ground_of(20));
    ASSERT_TRUE(site.come_to_rest()) << degrees;
    const Vec3 before = site.box().motion.X_WT.translation();
    site.run(2);
    EXPECT_EQ(site.active(), 0) << degrees;
    // Rows are solved in sixty iterations: their error is far below what a day would show.
    EXPECT_LT((site.box().motion.X_WT.translation() - before).norm(), 1e-6)
        << degrees << " deg, [m] in 2 s";
    EXPECT_NEAR(site.box().impulse.force_W.z() / (kMass * kGravity), 1, 1e-6) << degrees;
    EXPECT_EQ(site.solver().ledger().error(), 0);
  }
}

TEST(RestingContact, ABodyOnASlopeBeyondItsFrictionAngleSlidesAndTakesNone) {
  RestingBody site(radians(12), ground_of(6));
  const double before = site.box().motion.X_WT.translation().x();
  site.run(2);
  // Half of what 6 deg leave of the weight along 12 deg, as soil before its edge holds it.
  EXPECT_LT(site.box().motion.X_WT.translation().x() - before, -0.2);
  EXPECT_GT(site.active(), 0);
  EXPECT_EQ(site.solver().ledger().error(), 0);
}

TEST(RestingContact, FeetOfABodyOnASlopeAreItsCornersOnTheSlope) {
  const scene::Shell box = lab::closed_box(0.6, 0.6, 0.3);
  EXPECT_EQ(normal_under(Vec2(0.03, 0), 0.6, 0.1), Vec3::UnitZ())
      << "18 mm under the box, vertices may differ by 25";
  for (const double degrees : {5.0, 12.0, 25.0}) {
    const double slope = radians(degrees);
    const Vec3 normal = normal_under(Vec2(std::tan(slope), 0), 0.6, 0.1);
    EXPECT_TRUE(normal.isApprox(Vec3(-std::sin(slope), 0, std::cos(slope)), 1e-12));
    ToolMotion motion;
    motion.X_WT = make_pose(0, 0, 0, 0, -slope);
    motion.inverse_mass = Mat6::Identity();
    EXPECT_EQ(contact_vertices(box, motion.X_WT, 0.1, normal).size(), 4u);
    const auto takes = [&](const Vec3& up) {
      RestingContact contact;
      // Its weight acts 0.15 m over its lower face.
      const Vec3 force(0, 0, 1000), arm = motion.X_WT.linear() * Vec3(0, 0, 0.15);
      contact.start(box, motion, force, arm.cross(force), std::tan(radians(20)), 0.1, up);
      return contact.engaged;
    };
    EXPECT_EQ(takes(normal), degrees < 20) << degrees;
    EXPECT_FALSE(takes(Vec3::UnitZ())) << degrees << ": level ground has one edge to stand on";
  }
}

}  // namespace
}  // namespace navvy::soil
