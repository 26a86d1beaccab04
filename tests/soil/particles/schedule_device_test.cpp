// SPDX-License-Identifier: Apache-2.0
// Compares the schedule of work-groups with that of lanes, with a tool in the soil; both run on
// every device.
#include "soil/particles/schedule.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "core/error.h"
#include "soil/rig.h"

namespace navvy::soil {
namespace {

using rig::Rig;
using rig::SiteBox;

/// Sets the schedule during its lifetime.
class With {
 public:
  explicit With(const char* schedule) {
    const char* now = std::getenv("NAVVY_SOIL_SCHEDULE");
    if (now != nullptr) before_ = now;
    ::setenv("NAVVY_SOIL_SCHEDULE", schedule, 1);
  }
  ~With() {
    if (before_.empty())
      ::unsetenv("NAVVY_SOIL_SCHEDULE");
    else
      ::setenv("NAVVY_SOIL_SCHEDULE", before_.c_str(), 1);
  }
  With(const With&) = delete;
  With& operator=(const With&) = delete;

 private:
  std::string before_;
};

struct Outcome {
  std::vector<Particle> particles;
  Vec3 impulse = Vec3::Zero(), moment = Vec3::Zero();
  /// Of the nodal solve's momentum, worst step.
  double residual = 0;
  std::uint64_t digest = 0, rebins = 0, crossings = 0;
  std::int64_t ledger = 0;
};

/// Runs an open box with its cutting edge in a bed of two soils, cutting and turning;
/// `inverse_mass` > 0: it yields.
Outcome dig(const char* schedule, int steps, double inverse_mass = 0) {
  const With with(schedule);
  scene::Soil loam = rig::sand(28);
  loam.name = "loam";
  loam.cohesion = 5000;
  loam.residual_cohesion = 1000;
  loam.swell = 1.2;
  const SiteBox bed{Vec3(9, 9.2, -0.4), Vec3(11, 10.8, 0)};
  Rig rig({rig::sand(35), loam}, bed);
  auto soil = rig.fill(bed, true);
  for (Particle& p : soil)
    if (rig.position(p).y() > 10) p.soil = 1;
  rig.solver().insert(soil);
  ToolMotion motion;
  motion.tool = rig.solver().add_tool(rig::open_box(0.6, 0.8, 0.6));
  motion.X_WT = make_pose(10.31, 10.02, 0.12, 0, radians(-80), 0);
  motion.v_WT = Vec3(-0.8, 0, -0.3);
  motion.w_WT = Vec3(0, 0.5, 0);
  motion.inverse_mass = inverse_mass * Mat6::Identity();
  ToolImpulse impulse;
  Outcome out;
  const double dt = 1.5e-3;
  for (int i = 0; i < steps; ++i) {
    rig.solver().step(dt, std::span(&motion, 1), std::span(&impulse, 1));
    motion.X_WT.linear() = Eigen::AngleAxisd(0.5 * dt, Vec3::UnitY()) * motion.X_WT.linear();
    motion.X_WT.translation() += dt * motion.v_WT;
    out.impulse += impulse.J_W;
    out.moment += impulse.L_W;
    if (impulse.scale > 0)
      out.residual = std::max(out.residual, impulse.residual.norm() / impulse.scale);
  }
  out.particles = rig.solver().particles();
  out.digest = rig.digest();
  out.rebins = rig.solver().stats().rebins;
  out.crossings = rig.solver().stats().shell_crossings;
  out.ledger = rig.solver().ledger().error();
  return out;
}

struct Difference {
  double x = 0, v = 0, s = 0;  ///< largest [cells], [m/s], [Pa]
  double mean_x = 0;           ///< [cells]
};

Difference difference(const Outcome& a, const Outcome& b) {
  Difference out;
  EXPECT_EQ(a.particles.size(), b.particles.size());
  for (std::size_t i = 0; i < std::min(a.particles.size(), b.particles.size()); ++i) {
    const Particle &p = a.particles[i], &q = b.particles[i];
    EXPECT_EQ(p.id, q.id);
    EXPECT_EQ(p.mass, q.mass);
    double far = 0;
    for (int k = 0; k < 3; ++k) {
      const double shift = kBlockCells * (p.block[k] - q.block[k]);
      far = std::max(far,
                     std::abs(shift + static_cast<double>(p.x[k]) - static_cast<double>(q.x[k])));
      out.v = std::max(out.v, static_cast<double>(std::abs(p.v[k] - q.v[k])));
    }
    for (int k = 0; k < 6; ++k)
      out.s = std::max(out.s, static_cast<double>(std::abs(p.s[k] - q.s[k])));
    out.x = std::max(out.x, far);
    out.mean_x += far / static_cast<double>(a.particles.size());
  }
  return out;
}

// Their macros take any number of arguments, which NVIDIA's compiler does not allow.
constexpr const char* kLanesOnCpus = "the lanes are written for compilers of CPUs";

TEST(SoilSchedule, BothAgreeAfterOneStepToRounding) {
  if (Rig::device().info().kind == device::Kind::kGpu) GTEST_SKIP() << kLanesOnCpus;
  for (const double inverse_mass : {0.0, 0.01}) {
    const Outcome lanes = dig("lanes", 1, inverse_mass), groups = dig("groups", 1, inverse_mass);
    const Difference d = difference(lanes, groups);
    print_value("schedules after one step with a tool, positions [cells]", d.x, "< 2e-6",
                "float ulp of 4 cells");
    EXPECT_LT(d.x, 2e-6);
    // Sums of a node in another order.
    EXPECT_LT(d.v, 1e-5);
    EXPECT_LT(d.s, 0.1);
    ASSERT_GT(lanes.impulse.norm(), 1);
    EXPECT_LT((lanes.impulse - groups.impulse).norm(), 1e-5 * lanes.impulse.norm());
    EXPECT_LT((lanes.moment - groups.moment).norm(), 1e-5 * lanes.moment.norm());
  }
}

TEST(SoilSchedule, BothAgreeOverADigWithRebins) {
  if (Rig::device().info().kind == device::Kind::kGpu) GTEST_SKIP() << kLanesOnCpus;
  const Outcome lanes = dig("lanes", 120), groups = dig("groups", 120);
  const Difference d = difference(lanes, groups);
  print_value("schedules after 120 steps with a tool, positions, mean [cells]", d.mean_x, "< 1e-3",
              "rounding that grows");
  print_value("same, largest [cells]", d.x, "-", "-");
  EXPECT_GT(groups.rebins, 2u);
  EXPECT_LT(d.mean_x, 1e-5);  // twenty ulps of 4 cells
  EXPECT_LT((lanes.impulse - groups.impulse).norm(), 1e-4 * lanes.impulse.norm());
  EXPECT_LT(groups.residual, 1e-5);
  EXPECT_EQ(groups.crossings, lanes.crossings);
  EXPECT_EQ(groups.ledger, 0);
}

TEST(SoilSchedule, GroupsRepeatBitForBitAndAreNotTheLanes) {
  const Outcome first = dig("groups", 60, 0.01), again = dig("groups", 60, 0.01);
  EXPECT_GT(first.rebins, 0u);
  EXPECT_EQ(first.digest, again.digest);
  if (Rig::device().info().kind == device::Kind::kGpu) return;
  // Otherwise the variable would have no effect.
  EXPECT_NE(first.digest, dig("lanes", 60, 0.01).digest);
}

TEST(SoilSchedule, IsChosenByTheDeviceUnlessTheVariableSaysOtherwise) {
  const device::Device& device = Rig::device();
  {
    const With with("groups");
    EXPECT_EQ(schedule_for(device), Schedule::kGroups);
    EXPECT_EQ(kernel_path(device, "rebin"), "soil/groups/rebin.cl");
  }
  {
    const With with("lanes");
    EXPECT_EQ(kernel_path(device, "rebin"), "soil/lanes/rebin.cl");
  }
  {
    const With with("");
    EXPECT_EQ(schedule_for(device),
              device.info().kind == device::Kind::kGpu ? Schedule::kGroups : Schedule::kLanes);
  }
  const With with("both");
  EXPECT_THROW(schedule_for(device), InputError);
}

TEST(SoilSchedule, TakesTheNumberOfFewParticlesFromTheVariable) {
  const device::Device& device = Rig::device();
  ::setenv("NAVVY_FEW_PARTICLES", "2500", 1);
  EXPECT_EQ(few_particles(device), 2500);
  for (const char* wrong : {"-1", "nan", "many", "5 ", ""}) {
    ::setenv("NAVVY_FEW_PARTICLES", wrong, 1);
    EXPECT_THROW(few_particles(device), InputError) << wrong;
  }
  ::unsetenv("NAVVY_FEW_PARTICLES");
  EXPECT_GT(few_particles(device), 0);
}

}  // namespace
}  // namespace navvy::soil
