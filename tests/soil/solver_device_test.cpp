// SPDX-License-Identifier: Apache-2.0
// The particle solver without tools: comparison with the double twin, motion, ledger,
// repeatability.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>

#include "core/error.h"
#include "core/random.h"
#include "core/saved_state.h"
#include "flip_bytes.h"
#include "soil/reference/reference_solver.h"
#include "soil/rig.h"

namespace navvy::soil {
namespace {

using rig::Rig;
using rig::SiteBox;

/// Returns particles scattered over a few blocks, in motion and under stress.
std::vector<Particle> strewn(const Rig& rig, int count, std::uint64_t seed, const Vec3& low) {
  Random random(seed);
  std::vector<Particle> out;
  for (int i = 0; i < count; ++i) {
    const Vec3 at = low + Vec3(random.uniform(), random.uniform(), random.uniform())
                              .cwiseProduct(Vec3(0.9, 0.7, 0.8));
    Particle p = rig.particle(at, 1.25e-4, static_cast<int>(i % rig.world().soils.size()));
    for (float& v : p.v) v = static_cast<float>(random.uniform(-1, 1));
    for (float& c : p.c) c = static_cast<float>(random.uniform(-3, 3));
    for (int a = 3; a < 6; ++a) p.s[a] = static_cast<float>(random.uniform(-2000, 2000));
    p.j = static_cast<float>(random.uniform(0.98, 1.03));
    out.push_back(p);
  }
  return out;
}

class TwinTest : public testing::TestWithParam<int> {};

scene::Soil loam() {
  scene::Soil out = rig::sand(28);
  out.name = "loam";
  out.cohesion = 5000;
  out.residual_cohesion = 1000;
  out.swell = 1.2;
  return out;
}

void expect_agreement(const std::vector<scene::Soil>& soils, int count) {
  Rig rig(soils);
  const auto start = strewn(rig, count, 7, Vec3(10.03, 10.05, 0.07));
  rig.solver().insert(start);
  reference::ReferenceSolver twin(rig.world().soils, rig.cell(), rig.world().gravity,
                                  [](int, int) { return 40.0; });
  for (const Particle& p : start) twin.points.push_back(reference::from_particle(p));
  for (int i = 0; i < 6; ++i) {
    rig.solver().step(1.5e-3, {}, {});
    twin.step(1.5e-3);
  }
  const auto got = rig.solver().particles();
  ASSERT_EQ(got.size(), twin.points.size());
  double worst_x = 0, worst_v = 0, worst_s = 0;
  for (std::size_t i = 0; i < got.size(); ++i) {
    const reference::Point p = reference::from_particle(got[i]);
    worst_x = std::max(worst_x, (p.x - twin.points[i].x).cwiseAbs().maxCoeff());
    worst_v = std::max(worst_v, (p.v - twin.points[i].v).cwiseAbs().maxCoeff());
    for (std::size_t k = 0; k < 6; ++k)
      worst_s = std::max(worst_s, std::abs(p.s[k] - twin.points[i].s[k]));
  }
  print_value("float against double after 6 steps, positions [cells]", worst_x, "< 2e-5",
              "float ulp of 4 cells x steps");
  // Positions: a few ulp (4.8e-7) of an offset of up to 5.5 cells. Velocities: stress rounding (J
  // to 6e-8 times K = 1e6 Pa is 0.06 Pa) over six steps, and the yield decision may differ for a
  // particle on the surface.
  EXPECT_LT(worst_x, 2e-5);
  EXPECT_LT(worst_v, 2e-3);
  EXPECT_LT(worst_s, 20);
}

TEST_P(TwinTest, AgreesWithTheDoubleTwin) { expect_agreement({rig::sand(), loam()}, GetParam()); }

TEST_P(TwinTest, AgreesWithTheDoubleTwinWhenSoilsCompact) {
  scene::Soil sand = rig::sand(), soft = loam();
  // A step exerts some hundreds.
  soft.compaction_pressure = 200;
  expect_agreement({sand, soft}, GetParam());
}

TEST_P(TwinTest, AgreesWithTheDoubleTwinWhenSoilsDilateAndFeelRates) {
  scene::Soil sand = rig::sand(), dense = loam();
  sand.fast_friction_angle = sand.friction_angle + radians(10);
  sand.grain_diameter = 0.01;
  dense.dilatancy_angle = radians(10);
  expect_agreement({sand, dense}, GetParam());
}

INSTANTIATE_TEST_SUITE_P(Counts, TwinTest, testing::Values(1, 2, 15, 16, 17, 333, 1000));

TEST(SoilSolver, WithoutParticlesChangesNothing) {
  Rig rig({rig::sand()});
  rig.run(0.01);
  EXPECT_EQ(rig.solver().particles().size(), 0u);
  EXPECT_EQ(rig.solver().ledger().error(), 0);
}

TEST(SoilSolver, FallsAndFliesLikeABody) {
  Rig rig({rig::sand()});
  auto soil = rig.fill({Vec3(5, 5, 2), Vec3(5.3, 5.3, 2.3)});
  for (Particle& p : soil) {
    p.v[0] = 2;
    p.v[1] = 0.5;
    p.v[2] = 1;
  }
  rig.solver().insert(soil);
  Vec3 start = Vec3::Zero();
  for (const Particle& p : soil) start += rig.position(p) / static_cast<double>(soil.size());
  const double t = 0.4, dt = rig.run(t);
  Vec3 v = Vec3::Zero(), x = Vec3::Zero();
  for (const Particle& p : rig.solver().particles()) {
    v += Vec3(p.v[0], p.v[1], p.v[2]) / static_cast<double>(soil.size());
    x += rig.position(p) / static_cast<double>(soil.size());
  }
  const Vec3 v_expected(2, 0.5, 1 - kGravity * t);
  print_value("vertical speed after 0.4 s of free flight [m/s]", v.z(),
              std::to_string(v_expected.z()) + " +-1e-4 rel.",
              "[docs/validation.md, Element and law]");
  for (int a = 0; a < 3; ++a) EXPECT_NEAR(v[a], v_expected[a], 1e-4 * v_expected.norm());
  // Symplectic Euler is half a step behind the parabola; the rest is float rounding of positions.
  const Vec3 x_expected = start + Vec3(2, 0.5, 1) * t - Vec3(0, 0, 0.5 * kGravity * t * (t + dt));
  EXPECT_LT((x - x_expected).norm(), 1e-4);
}

TEST(SoilSolver, ConservesMomentumInInnerMotion) {
  Rig rig({rig::sand()});
  rig.solver().insert(strewn(rig, 500, 3, Vec3(10, 10, 3)));
  const auto momentum = [&](double& scale) {
    Vec3 sum = Vec3::Zero();
    scale = 0;
    for (const Particle& p : rig.solver().particles()) {
      sum += kilograms(p.mass) * Vec3(p.v[0], p.v[1], p.v[2]);
      scale += kilograms(p.mass) * Vec3(p.v[0], p.v[1], p.v[2]).norm();
    }
    return sum;
  };
  double scale = 0, ignored = 0, mass = 0;
  const Vec3 before = momentum(scale);
  for (const Particle& p : rig.solver().particles()) mass += kilograms(p.mass);
  const double t = 0.05;
  rig.run(t);
  const Vec3 change = momentum(ignored) - before - mass * rig.world().gravity * t;
  EXPECT_LT(change.norm(), 1e-4 * scale);  // rounding of floats
}

TEST(SoilSolver, RepeatsBitForBitAndASingleBitMatters) {
  std::uint64_t digests[3];
  for (int i = 0; i < 3; ++i) {
    Rig rig({rig::sand()});
    auto soil = rig.fill({Vec3(5, 5, 0), Vec3(5.5, 5.5, 0.6)});
    if (i == 2) soil[100].x[0] = std::nextafter(soil[100].x[0], 10.0f);
    rig.solver().insert(soil);
    rig.run(0.3);
    EXPECT_GT(rig.solver().stats().rebins, 1u);
    digests[i] = rig.digest();
  }
  EXPECT_EQ(digests[0], digests[1]);
  EXPECT_NE(digests[0], digests[2]);
}

TEST(SoilSolver, GoesOnFromASnapshotAsIfNothingHappened) {
  const SiteBox box{Vec3(5, 5, 0), Vec3(5.5, 5.5, 0.6)};
  Rig whole({rig::sand()});
  whole.solver().insert(whole.fill(box));
  whole.run(0.15);
  const std::vector<char> state = saved(whole.solver());
  whole.run(0.15);

  Rig resumed({rig::sand()});
  load_saved(state, resumed.solver());
  resumed.run(0.15);
  EXPECT_EQ(whole.digest(), resumed.digest());
}

// With a tool in the soil, in motion between two re-bins.
TEST(SoilSolver, EverySavedByteIsHashedOrRefused) {
  const SiteBox box{Vec3(5, 5, 0), Vec3(5.2, 5.2, 0.2)};
  Rig rig({rig::sand()}), target({rig::sand()});
  ToolMotion motion;
  for (Rig* each : {&rig, &target}) motion.tool = each->solver().add_tool(rig::blade(0.2, 0.2));
  motion.X_WT = make_pose(4.9, 5.1, 0.1);
  rig.solver().insert(rig.fill(box));
  ToolImpulse impulse;
  for (int i = 0; i < 5; ++i)
    rig.solver().step(1e-3, std::span(&motion, 1), std::span(&impulse, 1));
  EXPECT_EQ(test::flip_every_byte(rig.solver(), target.solver()), "");
}

TEST(SoilSolver, RefusesSoilThatNoSceneHas) {
  Rig rig({rig::sand()}), target({rig::sand()});
  rig.solver().insert(rig.fill({Vec3(5, 5, 0), Vec3(5.2, 5.2, 0.2)}));
  ByteMap map;
  const std::vector<char> state = saved(rig.solver(), &map);
  // The first field of that name with another number at its start is rejected by its name.
  const auto refused = [&](const std::string& name, std::int32_t value) {
    const auto field =
        std::find_if(map.fields.begin(), map.fields.end(), [&](const ByteMap::Field& f) {
          // Not a length.
          return f.path.ends_with(name) && f.size > sizeof(std::uint64_t);
        });
    std::vector<char> bytes = state;
    std::memcpy(bytes.data() + field->offset, &value, sizeof value);
    try {
      load_saved(bytes, target.solver());
    } catch (const InputError&) {
      return true;
    }
    return false;
  };
  const std::string tag = "[" + std::to_string(FIELD_TAG) + "]/words";
  EXPECT_FALSE(refused(tag, 0)) << "soil 0 is there";
  EXPECT_TRUE(refused(tag, 1)) << "there is one soil";
  EXPECT_TRUE(refused("block", std::numeric_limits<std::int32_t>::max()))
      << "its neighbours have no number";
  // A tool that only one of them has.
  target.solver().add_tool(rig::blade(0.2, 0.2));
  EXPECT_THROW(load_saved(state, target.solver()), InputError);
}

TEST(SoilSolver, IsTheSameEverywhereOnTheSite) {
  // Same soil at block (13, 13) and (2250, 1750) of a 1 km site: every number of the particles is
  // equal.
  std::vector<std::vector<Particle>> got;
  for (const Eigen::Vector3i& shift :
       {Eigen::Vector3i(13, 13, 10), Eigen::Vector3i(2250, 1750, 10)}) {
    Rig rig({rig::sand()}, {Vec3::Zero(), Vec3::Zero()}, 0.1, 10000);
    auto soil = rig.fill({Vec3(0, 0, 0), Vec3(0.5, 0.5, 0.6)});
    for (Particle& p : soil) {
      p.block[0] += shift.x();
      p.block[1] += shift.y();
    }
    rig.solver().insert(soil);
    rig.run(0.3);
    got.push_back(rig.solver().particles());
    EXPECT_LT(rig.ground().touched_tiles(), 4u);
  }
  ASSERT_EQ(got[0].size(), got[1].size());
  for (std::size_t i = 0; i < got[0].size(); ++i) {
    EXPECT_EQ(got[0][i].x[0], got[1][i].x[0]);
    EXPECT_EQ(got[0][i].x[2], got[1][i].x[2]);
    EXPECT_EQ(got[0][i].s[3], got[1][i].s[3]);
    EXPECT_EQ(got[0][i].j, got[1][i].j);
  }
}

TEST(SoilSolver, RecordsMassThatLeavesTheSite) {
  Rig rig({rig::sand()}, {Vec3::Zero(), Vec3::Zero()}, 0.1, 40);
  auto soil = rig.fill({Vec3(3.7, 2, 0.5), Vec3(3.9, 2.2, 0.7)});
  for (Particle& p : soil) p.v[0] = 3;
  const auto n = static_cast<std::int64_t>(soil.size());
  rig.solver().insert(soil);
  rig.run(0.2);
  const Ledger ledger = rig.solver().ledger();
  EXPECT_EQ(ledger.error(), 0);
  EXPECT_EQ(ledger.left_site[0], n * soil[0].mass);
  EXPECT_EQ(rig.solver().particles().size(), 0u);
}

TEST(SoilSolver, StopsAtANumberThatIsNotFinite) {
  for (const int where : {0, 1, 2}) {
    Rig rig({rig::sand()});
    auto soil = rig.fill({Vec3(5, 5, 0), Vec3(5.3, 5.3, 0.3)});
    const float nan = std::numeric_limits<float>::quiet_NaN();
    (where == 0 ? soil[17].v[1] : where == 1 ? soil[17].s[3] : soil[17].j) = nan;
    rig.solver().insert(soil);
    // A NaN counts as lost.
    EXPECT_EQ(rig.solver().ledger().error(), soil[17].mass);
    try {
      rig.run(0.01);
      FAIL() << "the run went on";
    } catch (const SimulationError& error) {
      EXPECT_NE(std::string(error.what()).find("not finite"), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("step 0"), std::string::npos) << error.what();
    }
  }
}

TEST(SoilSolver, RefusesAbsurdSoil) {
  scene::Soil soil = rig::sand();
  soil.bank_density = -1;
  soil.poisson = 0.5;
  try {
    soil_table({soil}, 0.1);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.faults().size(), 2u);
  }
}

}  // namespace
}  // namespace navvy::soil
