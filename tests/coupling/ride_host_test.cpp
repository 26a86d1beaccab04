// SPDX-License-Identifier: Apache-2.0
// The excavator on soft columns: sinkage of its wheels, evenness of their loads, and the resistance
// of their ruts.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "coupling/ride.h"
#include "coupling/rut_memory.h"
#include "terramechanics/bearing.h"
#include "terramechanics/plate.h"
#include "values.h"

namespace navvy::coupling {
namespace {

using testing::bed;
using testing::Ride;
using testing::shipped_machine;
using testing::shipped_soil;

// Offset of the machine's middle line: not on a column's edge for any cell size.
constexpr double kSide = 4.03;
constexpr double kWidth = 0.28, kTwin = 0.32, kTrack = 1.94;

/// Mean and root mean square deviation of the added values.
class Spread {
 public:
  void add(double value) { sum_ += value, squares_ += value * value, ++count_; }
  double mean() const { return sum_ / count_; }
  double rms() const { return std::sqrt(std::max(0.0, squares_ / count_ - mean() * mean())); }

 private:
  double sum_ = 0, squares_ = 0;
  int count_ = 0;
};

/// Returns the depth [m] of the left wheels' rut between the places x, in the middles of both
/// tyres.
double rut_depth(const heightfield::Ground& ground, double from, double to) {
  Spread depth;
  for (double x = from; x < to; x += 0.05)
    for (const double side : {-0.5 * kTwin, 0.5 * kTwin})
      depth.add(-ground.sample(x, kSide + 0.5 * kTrack + side));
  return depth.mean();
}

/// Returns the work of two equal passes that press the ground to `depth` [m], per unit of area
/// [J/m2]; without an exponent the second one adds nothing.
double work_of_two_passes(const scene::Soil& soil, double depth) {
  if (soil.multi_pass_exponent == 0) return terramechanics::plate_work(soil, depth, kWidth);
  const double once = depth / std::pow(2, 1 / soil.multi_pass_exponent);
  const double pressure = terramechanics::plate_pressure(soil, once, kWidth);
  RutMemory memory;
  const RutMemory::Press first = memory.press(soil, kWidth, 0, pressure);
  memory.height = -first.drop;
  memory.arrive(soil);
  const RutMemory::Press second = memory.press(soil, kWidth, memory.height, pressure);
  EXPECT_NEAR(first.drop + second.drop, depth, 1e-9);
  return first.work + second.work;
}

class RideSoil : public ::testing::TestWithParam<const char*> {
 protected:
  const scene::Machine machine_ = shipped_machine("ew180");
  const scene::Soil soil_ = shipped_soil(GetParam());
};

TEST_P(RideSoil, SinkageAndWheelLoadsDoNotDependOnTheCell) {
  std::vector<double> sinkage;
  for (const double cell : {0.2, 0.1, 0.05}) {
    heightfield::Ground ground = bed(soil_, cell, Vec2(12, 8)),
                        hard = bed(soil_, cell, Vec2(12, 8));
    Ride ride(machine_, ground, Vec2(3, kSide)), firm(machine_, hard, Vec2(3, kSide), true);
    ride.run(2);
    firm.run(2);
    const auto height = [](const Ride& one, int w) {
      return one.wheel(w).X_WWheel.translation().z();
    };
    std::vector<double> before;
    for (int w = 0; w < 4; ++w) {
      const double load = ride.wheel(w).force_W.z(), other = ride.wheel(w ^ 1).force_W.z();
      EXPECT_NEAR(load / other, 1, 0.05) << cell;  // of an axle
      before.push_back(height(ride, w));
      sinkage.push_back(height(firm, w) - height(ride, w));
    }
    ride.run(1);
    for (int w = 0; w < 4; ++w)
      EXPECT_NEAR(height(ride, w), before[static_cast<std::size_t>(w)], 1e-3) << cell;
    print_value("sinkage after 2 s, front left [m]", sinkage[sinkage.size() - 4],
                "equal within 10 % for each cell", "[docs/machines.md, ruts]");
  }
  for (std::size_t i = 4; i < sinkage.size(); ++i) EXPECT_NEAR(sinkage[i] / sinkage[i % 4], 1, 0.1);
}

TEST_P(RideSoil, LoadsStayEvenInItsOwnRutForAnyCell) {
  std::vector<double> depth, force;
  for (const double cell : {0.2, 0.1, 0.05}) {
    heightfield::Ground ground = bed(soil_, cell, Vec2(16, 8));
    Ride ride(machine_, ground, Vec2(2, kSide));
    ride.run(2);
    ride.engine().set_drive(0, {1.2, 0, false});
    ride.run(4);
    const double start = ride.place_of_base().x(), work = ride.engine().accounts()->work(0);
    std::vector<Spread> loads(4);
    ride.run(3, [&] {
      for (std::size_t w = 0; w < 4; ++w) loads[w].add(ride.wheel(static_cast<int>(w)).force_W.z());
    });
    for (const Spread& load : loads) {
      print_value("load, rms over mean", load.rms() / load.mean(), "0 .. 0.1",
                  "[docs/machines.md, ruts]");
      EXPECT_LT(load.rms(), 0.1 * load.mean()) << cell;
    }
    const double end = ride.place_of_base().x();
    EXPECT_NEAR(end - start, 3.6, 0.15);
    depth.push_back(rut_depth(ground, start, end - 1));
    force.push_back((ride.engine().accounts()->work(0) - work) / (end - start));
    print_value("drive [N]", force.back(), "equal within 10 % for each cell",
                "[docs/machines.md, tyres]");
    for (const std::int64_t change : ground.mass_change()) EXPECT_EQ(change, 0);
    print_value("rut [m]", depth.back(), "equal within 10 % for each cell",
                "[docs/machines.md, ruts]");
  }
  for (const double one : depth) EXPECT_NEAR(one / depth[0], 1, 0.1);
  for (const double one : force) EXPECT_NEAR(one / force[1], 1, 0.1);
  // The drive does the work of pressing two pairs of ruts, and rolls: R = b int p dz per tyre
  // [Bekker 1969], where the rear tyres pass again. Slip, soil pushed ahead of the tyres and the
  // steep front of the rut add to it, at most half as much again.
  const double rut = 4 * kWidth * work_of_two_passes(soil_, depth[1]);
  const double rolling = 0.02 * 18000 * kGravity;
  print_value("drive [N]", force[1], "1 .. 1.5 of " + std::to_string(rut + rolling),
              "[Bekker 1969]");
  EXPECT_GT(force[1], rut + rolling);
  EXPECT_LT(force[1], 1.5 * (rut + rolling));
  // One pair would push as much ahead in a single pass; the rear wheels meet only what they press
  // deeper.
  const double ahead = 4 * terramechanics::bulldozing({&soil_, 1}, kWidth, 0.525, depth[1], 1);
  print_value("four tyres push soil ahead at that depth [N]", ahead, "", "[Bekker 1969]");
}

TEST_P(RideSoil, SecondPassSinksLessThanThreeFifthsOfTheFirst) {
  heightfield::Ground ground = bed(soil_, 0.1, Vec2(14, 8));
  Ride ride(machine_, ground, Vec2(2, kSide));
  double before = 0;
  std::vector<double> added;
  for (const double speed : {1.2, -1.2, 1.2}) {  // both axles each time
    ride.engine().set_drive(0, {speed, 0, false});
    ride.run(4.5);
    const double depth = rut_depth(ground, 4, 5);
    added.push_back(depth - before);
    before = depth;
  }
  const bool repeats = soil_.multi_pass_exponent > 0;
  print_value("second pass over the first", added[1] / added[0],
              repeats ? "0.20 .. 0.45" : "0 .. 0.6", "[docs/machines.md, ruts]");
  EXPECT_GT(added[0], 0.03);
  EXPECT_GE(added[1], repeats ? 0.20 * added[0] : 0);
  EXPECT_LT(added[1], (repeats ? 0.45 : 0.6) * added[0]);
  EXPECT_LE(added[2], repeats ? 0.9 * added[1] : added[1] + 1e-6);  // heights are whole mass quanta
}

/// Height [m] of ground that is even to a tenth of a millimetre but not exactly. On exactly even
/// ground the two wheels of an open differential would slip equally until rounding has grown, so
/// that chance would decide when one of them spins.
double uneven(double x, double y) { return 1e-4 * std::sin(1e3 * (x + 2.7 * y)); }

/// Pulls every link back at its centre of mass by a share of its weight.
void hold_back(Ride& ride, const scene::Machine& machine, double share) {
  if (share == 0) return;
  for (std::size_t l = 0; l < machine.links.size(); ++l) {
    const int link = static_cast<int>(l);
    const Vec3 center = ride.engine().link(0, link).X_WL * machine.links[l].p_LCom;
    ride.engine().add_force(0, link, Vec3(-share * kGravity * machine.links[l].mass, 0, 0), center);
  }
}

/// Returns the speed [m/s] up a slope of soil after 6 s with its wheels in their ruts; 0.5 is
/// commanded. `pull`: a share of the weight that also holds it back.
double climbing_speed(const scene::Machine& machine, const scene::Soil& soil, double slope,
                      double pull) {
  heightfield::Ground ground = bed(soil, 0.1, Vec2(16, 8), [slope](double x, double y) {
    return (x - 4) * std::tan(slope) + uneven(x, y);
  });
  Ride ride(machine, ground, Vec2(4, kSide));
  ride.engine().set_drive(0, {0.5, 0, false});
  const auto pulled = [&] { hold_back(ride, machine, pull); };
  ride.run(6, pulled);
  const double start = ride.place_of_base().x();
  ride.run(2, pulled);
  return (ride.place_of_base().x() - start) / std::cos(slope) / 2;
}

TEST_P(RideSoil, StopsOnASlopeOfItsMobilisedFriction) {
  // Net traction of its wheels on the flat, after compaction and rolling resistance, as a share of
  // the weight: the friction they mobilise.
  double moves = 0, stops = 0.7;
  while (stops - moves > 0.01) {
    const double pull = 0.5 * (moves + stops);
    (climbing_speed(machine_, soil_, 0, pull) > 0.05 ? moves : stops) = pull;
  }
  const double limit = std::atan(stops);
  print_value("slope of the mobilised friction [deg]", degrees(limit), "",
              "[docs/machines.md, tyres]");
  const double steeper = climbing_speed(machine_, soil_, limit + radians(1), 0);
  const double gentler = climbing_speed(machine_, soil_, limit - radians(3), 0);
  print_value("speed up one steeper by 1 deg [m/s]", steeper, "below 0.05",
              "[docs/machines.md, tyres]");
  print_value("speed up one gentler by 3 deg [m/s]", gentler, "above 0.05",
              "[docs/machines.md, tyres]");
  EXPECT_LT(steeper, 0.05);
  EXPECT_GT(gentler, 0.05);
}

TEST_P(RideSoil, StandsStillUnderSoilThatLiesOnOneSideOfIt) {
  heightfield::Ground ground = bed(soil_, 0.1, Vec2(12, 8));
  Ride ride(machine_, ground, Vec2(4, kSide));
  // 3 t, half a metre left of the middle, as impulses of each step.
  const double weight = 3000 * kGravity;
  const auto load = [&] {
    const Pose X_WB = ride.engine().link(0, 0).X_WL;
    ride.engine().apply_impulse_of_step(0, 0, Vec3(0, 0, -weight * Ride::kStep), Vec3::Zero(),
                                        X_WB * Vec3(1.0, 0.5, 1.0), Ride::kStep);
  };
  ride.run(6, load);
  const Vec3 before = ride.place_of_base();
  ride.run(10, load);
  EXPECT_LT((ride.place_of_base() - before).norm(), 1e-3);
}

TEST(Ride, ClimbsASlopeOutOfItsOwnRuts) {
  heightfield::Ground ground = bed(shipped_soil("loam"), 0.1, Vec2(16, 8),
                                   [](double x, double) { return (x - 3) * std::tan(radians(8)); });
  Ride ride(shipped_machine("ew180"), ground, Vec2(3, kSide));
  double most = 0;
  ride.run(2, [&] {
    for (int w = 0; w < 4; ++w) most = std::max(most, ride.wheel(w).force_W.norm());
  });
  EXPECT_LT(most, 0.6 * 18000 * kGravity);  // it settles on its tyres without a blow
  ride.engine().set_drive(0, {0.8, 0, false});
  ride.run(4);
  EXPECT_GT(ride.place_of_base().x(), 4.5);
  // Two driven wheels overcome gravity, compaction and rolling: they slip, but no wheel digs itself
  // in.
  EXPECT_LT(ride.wheel(2).slip, 0.2);
}

TEST(Ride, ChassisBottomsOutOnSoilThatSlippingWheelsPushUp) {
  // Held back until its wheels dig themselves in.
  const scene::Soil soil = shipped_soil("loam");
  scene::Machine machine = shipped_machine("ew180");
  std::vector<double> supported;
  for (const bool has_chassis : {true, false}) {
    if (!has_chassis)
      for (scene::Link& link : machine.links) link.collisions.clear();
    heightfield::Ground ground = bed(soil, 0.1, Vec2(16, 8), uneven);
    Ride ride(machine, ground, Vec2(4, kSide));
    ride.engine().set_drive(0, {0.5, 0, false});
    double weight = 0;
    for (const scene::Link& link : machine.links) weight += kGravity * link.mass;
    double sum = 0;
    int steps = 0;
    ride.run(8, [&] {
      hold_back(ride, machine, 0.4);
      if (++steps <= 7 * 600) return;
      for (int w = 0; w < 4; ++w) sum += ride.wheel(w).force_W.z() / weight / 600;
    });
    supported.push_back(sum);
    print_value("share of the weight on the wheels", sum,
                has_chassis ? "below 0.95" : "1 within 3 %", "[docs/machines.md, ruts]");
  }
  EXPECT_LT(supported[0], 0.95);
  EXPECT_NEAR(supported[1], 1, 0.03);  // mean of a second in which it still rocks
}

INSTANTIATE_TEST_SUITE_P(Soils, RideSoil, ::testing::Values("loam", "sand_dry"),
                         [](const auto& tested) { return std::string(tested.param); });

TEST(Ride, LoadsStayEvenOnFirmGround) {
  heightfield::Ground ground = bed(shipped_soil("loam"), 0.2, Vec2(16, 8));
  Ride ride(shipped_machine("ew180"), ground, Vec2(2, kSide), true);
  ride.engine().set_drive(0, {1.2, 0, false});
  ride.run(4);
  std::vector<Spread> loads(4);
  ride.run(2, [&] {
    for (std::size_t w = 0; w < 4; ++w) loads[w].add(ride.wheel(static_cast<int>(w)).force_W.z());
  });
  for (const Spread& load : loads) EXPECT_LT(load.rms(), 0.1 * load.mean());
}

}  // namespace
}  // namespace navvy::coupling
