// SPDX-License-Identifier: Apache-2.0
// Soil that comes to rest: stress of level ground, collapse, swell. Coarse and small; finer ones
// run in ./dev validate.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>

#include "soil/rig.h"

namespace navvy::soil {
namespace {

using rig::Rig;
using rig::SiteBox;

TEST(SoilRest, LevelGroundKeepsItsPlaceAndTheStressOfItsWeight) {
  for (const double cohesion : {0.0, 5000.0}) {
    // At 30 the soil yields under the elastic rest ratio.
    scene::Soil soil = rig::sand(35);
    soil.cohesion = soil.residual_cohesion = cohesion;
    const SiteBox pit{Vec3(8.6, 8.6, -0.8), Vec3(11.4, 11.4, 0)};
    Rig rig({soil}, pit);
    const auto start = rig.fill(pit, true);
    rig.solver().insert(start);
    rig.run(1.0);
    const auto end = rig.solver().particles();
    ASSERT_EQ(end.size(), start.size());
    double farthest = 0, zz = 0, zs = 0, error2 = 0, weight = 0, ratio = 0;
    const double k0 = soil.poisson / (1 - soil.poisson);
    for (std::size_t i = 0; i < end.size(); ++i) {
      const Vec3 at = rig.position(end[i]);
      farthest = std::max(farthest, (at - rig.position(start[i])).norm());
      if (std::abs(at.x() - 10) > 0.5 || std::abs(at.y() - 10) > 0.5 || at.z() < -0.7 ||
          at.z() > -0.1)
        continue;
      const Particle& p = end[i];
      const double pressure =
          law_constants(soil, rig.cell()).bulk * std::max(0.0, 1.0 - p.j / p.j0);
      const double expected = soil.bank_density * kGravity * at.z(), got = p.s[2] - pressure;
      zz += expected * expected;
      zs += expected * got;
      ratio += (p.s[0] - pressure) / got;
      error2 += (got - expected) * (got - expected);
      weight += 1;
    }
    const double slope = zs / zz, rms = std::sqrt(error2 / zz);
    print_value("sigma_z / (rho g z), c " + std::to_string(cohesion), slope, "0.99 .. 1.01",
                "[docs/validation.md, Rest and stress]");
    print_value("rms of sigma_z", rms, "< 4 %", "[docs/validation.md, Rest and stress]");
    print_value("sigma_x / sigma_z", ratio / weight, std::to_string(k0) + " +-3 %",
                "[docs/validation.md, Rest and stress]");
    print_value("farthest motion in 1 s [mm]", farthest * 1000, "< 1",
                "[docs/validation.md, Rest and stress]");
    EXPECT_NEAR(slope, 1, 0.01);
    EXPECT_LT(rms, 0.04);
    EXPECT_NEAR(ratio / weight, k0, 0.03 * k0);
    EXPECT_LT(farthest, 1e-3);
    EXPECT_EQ(rig.solver().ledger().error(), 0);
  }
}

TEST(SoilRest, PlaneColumnCollapsesIntoTheBandOfTheExperiments) {
  // Between two smooth plates 0.5 m apart, against a third one; a = 1, L0 = 20 cells (the run with
  // the tolerance has 30).
  scene::Soil soil = rig::sand(33);
  soil.tool_friction_angle = 0;
  Rig rig({soil});
  const double length = 2, height = 2, gap = 0.5, x0 = 5.013, y0 = 10.007;
  scene::Shell channel;
  channel.name = "channel";
  channel.half_thickness = 0.02;
  const double far = 9, top = 3, below = -0.6;
  channel.vertices = {{far, 0, below}, {far, 0, top}, {0, 0, below},     {0, 0, top},
                      {0, gap, below}, {0, gap, top}, {far, gap, below}, {far, gap, top}};
  channel.triangles = {{0, 3, 1}, {0, 2, 3}, {2, 5, 3}, {2, 4, 5}, {4, 7, 5}, {4, 6, 7}};
  ToolMotion motion;
  motion.tool = rig.solver().add_tool(channel);
  motion.X_WT = make_pose(x0, y0, 0, 0, 0, 0);
  rig.solver().insert(rig.fill(
      {Vec3(x0 + 0.025, y0 + 0.025, 0), Vec3(x0 + length, y0 + gap - 0.025, height)}, true));
  ToolImpulse impulse;
  const double dt = rig.solver().step_limit(0);
  const double seconds = 3.2 * std::sqrt(height / kGravity);
  for (int i = 0; i < static_cast<int>(seconds / dt); ++i)
    rig.solver().step(dt, std::span(&motion, 1), std::span(&impulse, 1));
  std::vector<double> xs;
  for (const Particle& p : rig.solver().particles()) xs.push_back(rig.position(p).x());
  std::sort(xs.begin(), xs.end());
  const double front = xs[static_cast<std::size_t>(0.99 * static_cast<double>(xs.size()))];
  const double run_out = (front - x0 - length) / length;
  print_value("plane collapse a = 1, run-out / L0", run_out, "1.0 .. 1.8",
              "[Lube 2005], lower end for 20 cells [docs/validation.md, Columns and collapse]");
  // The tolerance is 1.2 .. 1.8 at L0 >= 30 cells; at 20 cells the method is known to stop 5-20 %
  // short.
  EXPECT_GT(run_out, 1.0);
  EXPECT_LT(run_out, 1.8);
  EXPECT_EQ(rig.solver().stats().shell_crossings, 0u);
}

/// Returns the mean volume ratio of a load of bank soil that was dumped from 1.2 m and has come to
/// rest. Single particles (cells with fewer than 4, where the bank has 8) keep the volume of their
/// flight and are left out.
double tipped(const scene::Soil& soil, double& speed) {
  Rig rig({soil});
  const Pose X = make_pose(10.03, 10.02, 1.2, 0, 0, 0);
  ToolMotion motion;
  motion.tool = rig.solver().add_tool(rig::open_box(1.0, 0.8, 0.6));
  motion.X_WT = X;
  ToolImpulse impulse;
  std::vector<Particle> load;
  for (double z = 0.04; z < 0.45; z += 0.05)
    for (double y = -0.36; y < 0.37; y += 0.05)
      for (double x = -0.46; x < 0.47; x += 0.05)
        load.push_back(rig.particle(X * Vec3(x, y, z), 1.25e-4));
  rig.solver().insert(load);
  const double dt = rig.solver().step_limit(1.5);
  const auto run = [&](double seconds) {
    for (double t = 0; t < seconds; t += dt) {
      rig.solver().step(dt, std::span(&motion, 1), std::span(&impulse, 1));
      const double angle = motion.w_WT.norm() * dt;
      if (angle > 0)
        motion.X_WT.linear() = Eigen::AngleAxisd(angle, Vec3::UnitY()) * motion.X_WT.linear();
      motion.X_WT.translation() += motion.v_WT * dt;
    }
  };
  motion.w_WT = Vec3(0, 2, 0);
  run(1.2);
  motion.w_WT = Vec3::Zero();
  motion.v_WT = Vec3(0, 0, 1.5);
  run(1.0);
  rig.run(1.2);
  double volume = 0, mass = 0;
  speed = 0;
  const auto cell_of = [&](const Particle& p) {
    const Vec3 at = rig.position(p) / rig.cell();
    return std::array<int, 3>{static_cast<int>(std::floor(at.x())),
                              static_cast<int>(std::floor(at.y())),
                              static_cast<int>(std::floor(at.z()))};
  };
  std::map<std::array<int, 3>, int> neighbours;
  for (const Particle& p : rig.solver().particles()) ++neighbours[cell_of(p)];
  for (const Particle& p : rig.solver().particles()) {
    if (neighbours[cell_of(p)] < 4) continue;
    volume += kilograms(p.mass) * static_cast<double>(p.j);
    mass += kilograms(p.mass);
    speed += kilograms(p.mass) * (p.v[0] * p.v[0] + p.v[1] * p.v[1] + p.v[2] * p.v[2]);
  }
  speed = std::sqrt(speed / mass);
  return volume / mass;
}

TEST(SoilSwell, DugAndDumpedSoilEndsAtItsSwell) {
  // The default is the loam of the first dig.
  scene::Soil loam;
  loam.name = "loam";
  scene::Soil dense = loam;
  dense.swell = 1;
  dense.cohesion = dense.residual_cohesion = 0;
  for (const scene::Soil& soil : {loam, dense}) {
    double speed = 0;
    const double ratio = tipped(soil, speed);
    print_value("volume of the tipped load / bank, c " + std::to_string(soil.cohesion), ratio,
                std::to_string(soil.swell) + " +-5 %",
                "[docs/validation.md, Swell, pouring and heaps]");
    EXPECT_NEAR(ratio, soil.swell, 0.05 * soil.swell);
    EXPECT_LT(speed, 0.05);
  }
}

/// Returns density / bank [-] in the middle of a heap of twice the particles that the bank has,
/// after it collapsed for 2 s. J alone does not show it: each particle has J = 1.
double crowded_density(bool crowding) {
  Rig rig({rig::sand(35)});
  rig.solver().set_crowding(crowding);
  const SiteBox box{Vec3(9.5, 9.5, 0), Vec3(10.5, 10.5, 0.5)};
  auto soil = rig.fill(box);
  const auto twice = soil;
  for (Particle p : twice) {
    p.x[0] += 0.25f;
    p.x[1] += 0.25f;
    soil.push_back(p);
  }
  rig.solver().insert(soil);
  rig.run(2.0);
  // Mass of the cells over the middle of the heap, clear of its surface.
  std::map<std::array<int, 3>, double> cells;
  for (const Particle& p : rig.solver().particles()) {
    const Vec3 at = rig.position(p) / rig.cell();
    cells[{static_cast<int>(std::floor(at.x())), static_cast<int>(std::floor(at.y())),
           static_cast<int>(std::floor(at.z()))}] += kilograms(p.mass);
  }
  double mass = 0;
  for (int z = 0; z < 3; ++z)
    for (int y = 98; y < 103; ++y)
      for (int x = 98; x < 103; ++x) mass += cells[{x, y, z}];
  return mass / (75 * std::pow(rig.cell(), 3)) / rig.world().soils[0].bank_density;
}

// The heap shears where it slides apart, and there it spreads; its resting core stays
// [docs/soil.md, crowding].
TEST(SoilRest, CrowdedSoilSpreadsWhereItShears) {
  const double with = crowded_density(true), without = crowded_density(false);
  print_value("crowded soil after 2 s, density / bank", with, "2 at the start",
              "[docs/soil.md, crowding]");
  print_value("the same without moving particles apart", without, "2 at the start",
              "[docs/soil.md, crowding]");
  EXPECT_LT(with, without - 0.1);
  EXPECT_GT(with, 1);
}

}  // namespace
}  // namespace navvy::soil
