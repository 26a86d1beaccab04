// SPDX-License-Identifier: Apache-2.0
// A tool that stands: its soil goes back to columns, which bear it until more is asked of them.
#include <gtest/gtest.h>

#include "lab/shapes.h"
#include "soil/rig.h"
#include "soil/tools/seat.h"

namespace navvy::soil {
namespace {

constexpr double kMass = 300, kHeight = 0.3;  // 8 kPa on ground of 5 kPa

/// A site whose ground wakes and takes soil back, with a box laid on it.
class Laid : public lab::Site {
 public:
  Laid() : Site(rig::Rig::device(), {lab::cohesive(28, 5000)}, 0.1, options()) {
    scene::Shell shell = lab::closed_box(0.6, 0.6, kHeight);
    for (Vec3& v : shell.vertices) v.z() -= kHeight / 2;
    box_ = add_tool(shell, make_pose(0.02, 0.01, kHeight / 2 + 0.05));
    box().mass = kMass;
    box().inertia = kMass / 12 * Vec3(0.45, 0.45, 0.72);
  }
  lab::Tool& box() { return tool(box_); }
  double height() { return box().motion.X_WT.translation().z(); }
  int awake() const { return solver().stats().particles; }
  /// Until no particle is left; false when some are after 15 s.
  bool come_to_rest() {
    for (int i = 0; i < 30; ++i) {
      run(0.5);
      if (awake() == 0) return true;
    }
    return false;
  }

 private:
  static lab::SiteOptions options() {
    lab::SiteOptions out;
    out.size = 4;
    out.depth = 1;
    out.exchange = true;
    return out;
  }
  int box_ = 0;
};

TEST(Seat, ABodyThatStandsIsBorneByColumnsAndDoesNotMove) {
  Laid site;
  ASSERT_TRUE(site.come_to_rest());
  const double before = site.height();
  site.run(2);
  EXPECT_EQ(site.awake(), 0);
  EXPECT_NEAR(site.height(), before, 1e-9) << "[m] in 2 s";
  EXPECT_NEAR(site.box().impulse.force_W.z() / (kMass * kGravity), 1, 1e-6);
  EXPECT_EQ(site.solver().ledger().error(), 0);
}

TEST(Seat, UnderMoreThanItBoreTheGroundWakesAndBearsAnew) {
  Laid site;
  ASSERT_TRUE(site.come_to_rest());
  const double before = site.height();
  site.box().force_W = Vec3(0, 0, -2 * kMass * kGravity);
  site.run(0.5);
  EXPECT_GT(site.awake(), 0);
  ASSERT_TRUE(site.come_to_rest());
  EXPECT_LT(site.height(), before + 1e-3);
  EXPECT_GT(site.height(), before - 0.1) << "a cell";
  EXPECT_NEAR(site.box().impulse.force_W.z() / (3 * kMass * kGravity), 1, 1e-6);
  EXPECT_EQ(site.solver().ledger().error(), 0);
}

TEST(Seat, IsLeftByABodyThatIsLiftedOrPushedAside) {
  for (const Vec3& push : {Vec3(0, 0, 1.5 * kMass * kGravity), Vec3(0.8 * kMass * kGravity, 0, 0)}) {
    Laid site;
    ASSERT_TRUE(site.come_to_rest());
    const Vec3 before = site.box().motion.X_WT.translation();
    site.box().force_W = push;
    site.run(0.3);
    // Half of what it would go without any ground is more than friction of 20 degrees takes away.
    EXPECT_GT((site.box().motion.X_WT.translation() - before).norm(), 0.05) << push;
    EXPECT_EQ(site.solver().ledger().error(), 0);
  }
}

TEST(Seat, GoesOnFromASnapshotAsIfNothingHappened) {
  Laid site, other;
  ASSERT_TRUE(site.come_to_rest());
  const std::vector<char> ground = saved(site.ground()), soil = saved(site.solver());
  load_saved(ground, other.ground());
  load_saved(soil, other.solver());
  other.box().motion = site.box().motion;
  for (Laid* each : {&site, &other}) {
    each->run(0.5);
    each->box().force_W = Vec3(0, 0, -2 * kMass * kGravity);
    each->run(0.5);
  }
  EXPECT_GT(site.awake(), 0);
  EXPECT_EQ(site.digest(), other.digest());
  EXPECT_EQ(site.height(), other.height());
}

TEST(Seat, IsTakenOnlyWhereTheFeetBear) {
  const scene::Shell box = lab::closed_box(0.6, 0.6, 0.3);
  ToolMotion motion;
  motion.inverse_mass = Mat6::Identity();
  EXPECT_EQ(feet(box, motion.X_WT, 0.1).size(), 4u);
  const auto takes = [&](const Vec3& force, const Vec3& moment) {
    Seat seat;
    seat.take(box, motion, force, moment, 0.36, 0.1);
    return seat.taken;
  };
  EXPECT_TRUE(takes(Vec3(0, 0, 1000), Vec3::Zero()));
  EXPECT_TRUE(takes(Vec3(300, 0, 1000), Vec3::Zero())) << "by friction";
  EXPECT_FALSE(takes(Vec3(500, 0, 1000), Vec3::Zero()));
  EXPECT_FALSE(takes(Vec3(0, 0, 1000), Vec3(0, -400, 0))) << "0.4 m aside, where no foot is";
}

}  // namespace
}  // namespace navvy::soil
