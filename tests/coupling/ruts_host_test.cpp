// SPDX-License-Identifier: Apache-2.0
#include "coupling/ruts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/saved_state.h"
#include "flip_bytes.h"
#include "heightfield/volume_change.h"
#include "soil/exchange/exchange.h"
#include "terramechanics/plate.h"
#include "values.h"

namespace navvy::coupling {
namespace {

heightfield::Ground flat(const scene::Soil& soil, int columns = 64, double cell = 0.1) {
  heightfield::Ground::Setup setup;
  setup.nx = setup.ny = columns;
  setup.cell = cell;
  setup.datum = -2;
  setup.soils = {soil};
  setup.layers = {{soil.name, 10}};
  setup.surface = [](int, int) { return 0.0; };
  return heightfield::Ground(std::move(setup));
}

heightfield::Ground flat_loam(int columns = 64) {
  scene::Soil loam;
  loam.name = "loam";
  return flat(loam, columns);
}

// Returns terrain/soils/sand_dry.sdf as far as ruts and slumping need it.
scene::Soil dry_sand() {
  scene::Soil sand;
  sand.name = "sand_dry";
  sand.bank_density = 1600;
  sand.swell = 1.13;
  sand.friction_angle = radians(31);
  sand.cohesion = sand.residual_cohesion = 0;
  sand.bekker_kc = 990;
  sand.bekker_kphi = 1528430;
  sand.bekker_n = 1.1;
  return sand;
}

scene::Wheel twin_tyre() {
  scene::Wheel wheel;
  wheel.twin_spacing = 0.32;
  return wheel;
}

vehicle::WheelState loaded_at(double x, double y, double load) {
  vehicle::WheelState state;
  state.X_WWheel.translation() = Vec3(x, y, 0.5);
  state.force_W = Vec3(0, 0, load);
  return state;
}

double deepest(const heightfield::Ground& ground) {
  double least = 0;
  for (int iy = 0; iy < ground.ny(); ++iy)
    for (int ix = 0; ix < ground.nx(); ++ix) least = std::min(least, ground.height(ix, iy));
  return -least;
}

/// Returns the largest drop between columns at this distance along an axis, divided by the
/// distance.
double steepest(const heightfield::Ground& ground, int apart = 1) {
  double most = 0;
  for (int iy = 0; iy + apart < ground.ny(); ++iy)
    for (int ix = 0; ix + apart < ground.nx(); ++ix)
      most = std::max({most, std::abs(ground.height(ix + apart, iy) - ground.height(ix, iy)),
                       std::abs(ground.height(ix, iy + apart) - ground.height(ix, iy))});
  return most / (apart * ground.cell());
}

TEST(Ruts, PressSinksTheTreadAndKeepsTheMass) {
  heightfield::Ground ground = flat_loam();
  Ruts ruts(ground);
  ruts.press({{twin_tyre(), loaded_at(3.2, 3.2, 45e3)}});
  const double depth = deepest(ground);
  // A quarter of 18 t on loam: the plate law gives centimetres, less than a cell.
  EXPECT_GT(depth, 0.01);
  EXPECT_LT(depth, 0.10);
  for (const std::int64_t change : ground.mass_change()) EXPECT_EQ(change, 0);
}

TEST(Ruts, StandingStillAndAnEqualPassAddNothingButAHeavierOneDoes) {
  heightfield::Ground ground = flat_loam();
  Ruts ruts(ground);
  ruts.press({{twin_tyre(), loaded_at(3.2, 3.2, 30e3)}});
  const double once = deepest(ground);
  for (int i = 0; i < 5; ++i) ruts.press({{twin_tyre(), loaded_at(3.2, 3.2, 30e3)}});
  EXPECT_DOUBLE_EQ(deepest(ground), once);
  ruts.press({{twin_tyre(), loaded_at(3.2, 3.2, 60e3)}});
  EXPECT_GT(deepest(ground), once);
}

TEST(Ruts, SecondPassByAHeavierMachineSinksByItsOwnPressure) {
  for (const scene::Soil& soil : {flat_loam(1).setup().soils[0], dry_sand()}) {
    heightfield::Ground twice = flat(soil), once = flat(soil);
    Ruts ruts(twice);
    ruts.press({{twin_tyre(), loaded_at(3.2, 3.2, 20e3)}});
    const double light = deepest(twice);
    ruts.press({{twin_tyre(), loaded_at(3.2, 3.2, 44e3)}});
    Ruts(once).press({{twin_tyre(), loaded_at(3.2, 3.2, 44e3)}});
    print_value("20 kN [m]", light, "", "[docs/machines.md, ruts]");
    print_value("then 44 kN [m]", deepest(twice), std::to_string(deepest(once)) + " by itself",
                "[Bekker 1969]");
    EXPECT_LT(light, 0.9 * deepest(once));
    EXPECT_NEAR(deepest(twice), deepest(once), 1e-5);
    // The light machine again: nothing is added.
    ruts.press({{twin_tyre(), loaded_at(3.2, 3.2, 20e3)}});
    EXPECT_NEAR(deepest(twice), deepest(once), 1e-5);
  }
}

/// Presses the ground under a tyre at one place, then at another, so that it leaves the first.
void pass(Ruts& ruts, double load) {
  ruts.press({{twin_tyre(), loaded_at(3.2, 3.2, load)}});
  ruts.press({{twin_tyre(), loaded_at(5.6, 5.6, 1e3)}});
}

TEST(Ruts, RepeatedPassesSinkAsTheRootOfTheirNumber) {
  for (const double exponent : {2.5, 3.5, 4.5}) {
    scene::Soil soil = flat_loam(1).setup().soils[0];
    soil.multi_pass_exponent = exponent;
    heightfield::Ground ground = flat(soil);
    Ruts ruts(ground);
    double first = 0, before = 0, added = 1;
    for (int n = 1; n <= 4; ++n) {
      pass(ruts, 44e3);
      const double depth = deepest(ground);
      if (n == 1) first = depth;
      // 0.2 mm: heights are whole mass quanta, and the tread's ends overlap.
      EXPECT_NEAR(depth, first * std::pow(n, 1 / exponent), 2e-4) << "pass " << n;
      if (n > 1) EXPECT_LT(depth - before, added);
      added = depth - before;
      before = depth;
      // Standing adds nothing.
      ruts.press({{twin_tyre(), loaded_at(3.2, 3.2, 20e3)}});
    }
  }
}

TEST(Ruts, AnExponentOfZeroAddsNothingInRepeatedPasses) {
  scene::Soil soil = flat_loam(1).setup().soils[0];
  soil.multi_pass_exponent = 0;
  heightfield::Ground ground = flat(soil);
  Ruts ruts(ground);
  pass(ruts, 44e3);
  const double first = deepest(ground);
  pass(ruts, 44e3);
  EXPECT_EQ(deepest(ground), first);
}

TEST(RutMemory, WorkOfARepeatedPassIsItsPressureOverItsSinkage) {
  scene::Soil soil = flat_loam(1).setup().soils[0];
  soil.multi_pass_exponent = 3;
  constexpr double kWidth = 0.3, kPressure = 150e3;
  RutMemory memory;
  const RutMemory::Press first = memory.press(soil, kWidth, 0, kPressure);
  EXPECT_NEAR(first.work, kPressure * first.drop / (soil.bekker_n + 1), 1e-6 * first.work);
  memory.height = -first.drop;
  memory.arrive(soil);
  const RutMemory::Press second = memory.press(soil, kWidth, -first.drop, kPressure);
  EXPECT_NEAR(second.drop, first.drop * (std::cbrt(2.0) - 1), 1e-9);
  // Less than the load over the whole drop, and more than half of it: the pressure grows from 0.
  EXPECT_LT(second.work, kPressure * second.drop);
  EXPECT_GT(second.work, 0.5 * kPressure * second.drop);
  // Pressed by and by it takes the same.
  RutMemory again = memory;
  again.pressure = again.arrived = kPressure;
  double work = 0, drop = 0;
  for (const double share : {0.3, 0.6, 0.8, 1.0}) {
    const RutMemory::Press part = again.press(soil, kWidth, -first.drop - drop, share * kPressure);
    work += part.work;
    drop += part.drop;
  }
  EXPECT_NEAR(drop, second.drop, 1e-9);
  EXPECT_NEAR(work, second.work, 0.01 * second.work);
}

TEST(RutMemory, RepeatedPassesAreFiniteAtBothEndsOfTheExponent) {
  constexpr double kWidth = 0.3;
  for (const double exponent : {1.0, 20.0})
    // The later load a little, or by far, the lighter or the heavier one.
    for (const double ratio : {1e-6, 0.5, 1.0, 2.0, 1e6}) {
      scene::Soil soil = flat_loam(1).setup().soils[0];
      soil.multi_pass_exponent = exponent;
      const double pressure = ratio > 1 ? 1e2 : 1e5;
      RutMemory memory;
      const double first = memory.press(soil, kWidth, 0, pressure).drop;
      memory.height = -first;
      memory.arrive(soil);
      const RutMemory::Press second = memory.press(soil, kWidth, -first, ratio * pressure);
      const double alone = terramechanics::plate_sinkage(soil, ratio * pressure, kWidth);
      const double more = std::max(first, alone), less = std::min(first, alone);
      const double expected = more * std::pow(1 + std::pow(less / more, exponent), 1 / exponent);
      EXPECT_NEAR(first + second.drop, expected, 1e-6 * expected) << exponent << ' ' << ratio;
      EXPECT_TRUE(std::isfinite(second.work)) << exponent << ' ' << ratio;
      EXPECT_GE(second.work, 0) << exponent << ' ' << ratio;
      // No load does more work than itself over what it presses deeper.
      EXPECT_LE(second.work, 1.001 * ratio * pressure * second.drop + 1e-9);
      // At 1 the depths add up, at 20 the larger one remains but for 4 %.
      if (exponent == 1) EXPECT_NEAR(first + second.drop, first + alone, 1e-6 * expected);
      if (exponent == 20) EXPECT_LT(first + second.drop, 1.04 * more);
    }
}

TEST(Ruts, PressFreshSoilDownToTheirOldFloor) {
  heightfield::Ground ground = flat_loam();
  Ruts ruts(ground);
  ruts.press({{twin_tyre(), loaded_at(3.2, 3.2, 44e3)}});
  const Vec2i at = ground.column_at(3.2, 3.36);
  const double floor = ground.height(at.x(), at.y());
  // Slides in 15 mm of soil, which a wheel presses out in many steps.
  const auto fill = [&](double depth) {
    heightfield::SoilLayer loose = ground.layers(at.x(), at.y()).back();
    loose.specific_volume = 1.2f;
    const double area = ground.cell() * ground.cell();
    loose.mass =
        std::llround(depth * area * ground.setup().soils[0].bank_density / 1.2 / kMassQuantum);
    ground.put(at.x(), at.y(), loose);
  };
  fill(0.015);
  EXPECT_NEAR(ground.height(at.x(), at.y()), floor + 0.015, 1e-3);
  for (double load = 4e3; load <= 44e3; load += 4e3)
    ruts.press({{twin_tyre(), loaded_at(3.2, 3.2, load)}});
  EXPECT_NEAR(ground.height(at.x(), at.y()), floor, 1e-3);
  // A layer thicker than a tyre can press through stays on it.
  fill(0.2);
  const double high = ground.height(at.x(), at.y());
  ruts.press({{twin_tyre(), loaded_at(3.2, 3.2, 44e3)}});
  EXPECT_LT(ground.height(at.x(), at.y()), high - 0.03);
  EXPECT_GT(ground.height(at.x(), at.y()), floor + 0.1);
}

TEST(Ruts, PressingOverTimeGivesTheDepthOfOnePress) {
  heightfield::Ground once = flat_loam(), slowly = flat_loam();
  Ruts(once).press({{twin_tyre(), loaded_at(3.2, 3.2, 45e3)}});
  Ruts ruts(slowly);
  ruts.press({{twin_tyre(), loaded_at(3.2, 3.2, 45e3)}}, 0.0133);
  // Soil that falls on the ground does not sink at once.
  EXPECT_LT(deepest(slowly), 0.2 * deepest(once));
  for (int i = 0; i < 300; ++i) ruts.press({{twin_tyre(), loaded_at(3.2, 3.2, 45e3)}}, 0.0133);
  // Columns hold whole mass quanta: heights are exact to a micrometre, in some dozen presses.
  EXPECT_NEAR(deepest(slowly), deepest(once), 5e-5);
}

TEST(Ruts, ReportTheWorkAndTheSinkageOfATyre) {
  heightfield::Ground ground = flat_loam();
  Ruts ruts(ground);
  EXPECT_EQ(ruts.sinking(3.2, 3.36).work, 0);
  ruts.press({{twin_tyre(), loaded_at(3.2, 3.2, 45e3)}});
  const scene::Soil& loam = ground.setup().soils[0];
  const double z = deepest(ground);
  // int p dz of Bekker's law; 1e-4: heights are whole mass quanta.
  const double expected = terramechanics::plate_work(loam, z, 0.28);
  EXPECT_NEAR(ruts.sinking(3.2, 3.36).work, expected, 1e-4 * expected);
  EXPECT_NEAR(ruts.sinking(3.2, 3.36).depth, z, 1e-4 * z);
  EXPECT_EQ(ruts.sinking(4.5, 3.36).work, 0);
  // There and back: the second passage takes no work where the first one carried as much.
  ruts.press({{twin_tyre(), loaded_at(4.5, 3.2, 45e3)}});
  EXPECT_EQ(ruts.sinking(3.2, 3.36).work, 0);
  ruts.press({{twin_tyre(), loaded_at(3.2, 3.2, 45e3)}});
  EXPECT_EQ(ruts.sinking(3.2, 3.36).work, 0);
  EXPECT_EQ(ruts.sinking(3.2, 3.36).depth, 0);
}

TEST(Ruts, SinkDeeperUnderAWheelThatSlips) {
  heightfield::Ground rolled = flat_loam(), spun = flat_loam();
  Ruts(rolled).press({{twin_tyre(), loaded_at(3.2, 3.2, 30e3)}});
  vehicle::WheelState wheel = loaded_at(3.2, 3.2, 30e3);
  wheel.slip = 0.4;
  Ruts(spun).press({{twin_tyre(), wheel}});
  // (1 + 0.4) / (1 - 0.2) [Lyasko 2010]; 1e-4: heights are whole mass quanta.
  EXPECT_NEAR(deepest(spun), 1.75 * deepest(rolled), 1e-4);
}

TEST(Ruts, EndsRiseWithTheTread) {
  heightfield::Ground ground = flat_loam();
  Ruts ruts(ground);
  ruts.press({{twin_tyre(), loaded_at(3.2, 3.2, 45e3)}});
  // Columns are 0.05, 0.15, 0.25 m ahead; the tread leaves the ground between 0.2 and 0.3 m.
  const Vec2i at = ground.column_at(3.25, 3.35);
  const double middle = -ground.height(at.x(), at.y()), end = -ground.height(at.x() + 2, at.y());
  EXPECT_GT(middle, 0.01);
  EXPECT_GT(end, 0.2 * middle);
  EXPECT_LT(end, 0.8 * middle);
}

// Dry sand with one wheel pressed as often as a world presses it, and slides by itself.
class SandBed {
 public:
  SandBed() : ground(flat(dry_sand())), ruts(ground), exchange_(world(), ground) {}

  void stand(double seconds, double load) {
    const double interval = 0.012;  // [s] as in the coupling
    for (int n = static_cast<int>(std::lround(seconds / interval)); n > 0; --n) {
      ruts.press({{twin_tyre(), loaded_at(3.2, 3.2, load)}}, interval);
      slumped += exchange_.check({}, {}, time_, interval).slumped_columns;
      time_ += interval;
    }
  }

  heightfield::Ground ground;
  Ruts ruts;
  int slumped = 0;

 private:
  static scene::Scene world() {
    scene::Scene out;
    out.soils = {dry_sand()};
    return out;
  }
  soil::Exchange exchange_;
  double time_ = 0;
};

TEST(Ruts, AreNotDeepenedBySandThatSlidesFromTheirWalls) {
  SandBed bed;
  bed.stand(3, 44e3);  // the excavator's heavier wheels
  const double early = deepest(bed.ground);
  bed.stand(27, 44e3);
  const double late = deepest(bed.ground);
  const double lowered = heightfield::testing::volume_change(bed.ground).lowered;
  print_value("rut under 44 kN on dry sand after 30 s [m]", late, "0.10 .. 0.16",
              "[docs/machines.md, ruts]");
  // Bekker's law for the pressure of this tyre: 0.114 m where the tyre rests on its own sinkage.
  EXPECT_GT(late, 0.10);
  EXPECT_LT(late, 0.16);
  EXPECT_LT(late - early, 0.001);
  // The rut alone has 0.6 m2 of contact; pumping would lower five times that.
  EXPECT_LT(lowered, 0.1);
  for (const std::int64_t change : bed.ground.mass_change()) EXPECT_EQ(change, 0);
}

TEST(Ruts, WallsSlideWhenTheTyreHasLeft) {
  SandBed bed;
  bed.stand(5, 44e3);
  // A rut 0.105 m deep beside columns 0.1 m away: 46 deg.
  EXPECT_GT(steepest(bed.ground), std::tan(radians(45)));
  const int before = bed.slumped;
  bed.stand(5, 0);
  EXPECT_GT(bed.slumped, before);
  // Between adjacent columns more than phi + 2 remains; over two columns it is less.
  print_value("steepest over two columns", steepest(bed.ground, 2), "at most tan(phi + 2 deg)",
              "[docs/exchange.md, slump]");
  EXPECT_LT(steepest(bed.ground, 2), std::tan(radians(31 + 2)));
}

/// Bank volume [m3] gained by columns, and the largest height above the start [m].
struct Edges {
  double volume = 0, height = 0;
};

Edges edges(const heightfield::Ground& ground) {
  Edges out;
  for (int iy = 0; iy < ground.ny(); ++iy)
    for (int ix = 0; ix < ground.nx(); ++ix) {
      std::int64_t mass = 0;
      std::vector<heightfield::SoilLayer> start;
      for (const heightfield::SoilLayer& layer : ground.layers(ix, iy)) mass += layer.mass;
      ground.start_column(ix, iy, start);
      for (const heightfield::SoilLayer& layer : start) mass -= layer.mass;
      out.volume += std::max(0.0, kilograms(mass)) / ground.setup().soils[0].bank_density;
      out.height = std::max(out.height, ground.height(ix, iy) - ground.start_height(ix, iy));
    }
  return out;
}

TEST(Ruts, EdgesRiseByTheLoadTheGroundCannotSupport) {
  std::vector<double> volume;
  for (const double cell : {0.2, 0.1, 0.05}) {
    heightfield::Ground ground = flat(dry_sand(), static_cast<int>(std::lround(6.4 / cell)), cell);
    Ruts ruts(ground);
    for (int i = 0; i < 300; ++i) ruts.press({{twin_tyre(), loaded_at(3.2, 3.2, 44e3)}}, 0.0133);
    const Edges once = edges(ground);
    print_value("bank volume pushed aside by 44 kN on dry sand [m3]", once.volume,
                "equal within 20 % for each cell", "[Terzaghi 1943]");
    print_value("volume of the rut [m3]", heightfield::testing::volume_change(ground).lowered, "",
                "[docs/machines.md, ruts]");
    print_value("highest edge [m]", once.height, "", "[docs/machines.md, ruts]");
    EXPECT_GT(once.height, 0.004);
    EXPECT_LT(once.height, deepest(ground));
    volume.push_back(once.volume);
    for (const std::int64_t change : ground.mass_change()) EXPECT_EQ(change, 0);
    // Equal on both sides: rows mirror each other to a few units of mass.
    for (int iy = 0; iy < ground.ny(); ++iy)
      for (int ix = 0; ix < ground.nx(); ++ix)
        EXPECT_NEAR(ground.height(ix, iy), ground.height(ix, ground.ny() - 1 - iy), 1e-5)
            << ix << " " << iy;
    // While the wheel stays, no more soil is displaced.
    ruts.press({{twin_tyre(), loaded_at(3.2, 3.2, 44e3)}}, 0.0133);
    EXPECT_NEAR(edges(ground).volume, once.volume, 1e-6);
  }
  for (const double one : volume) EXPECT_NEAR(one / volume[1], 1, 0.2);
}

TEST(Ruts, EdgesOfGroundThatSupportsTheTyreStay) {
  heightfield::Ground ground = flat_loam();
  Ruts ruts(ground);
  ruts.press({{twin_tyre(), loaded_at(3.2, 3.2, 44e3)}});
  EXPECT_GT(deepest(ground), 0.02);
  EXPECT_EQ(edges(ground).volume, 0);
}

TEST(Ruts, PressEvenWhereNothingCanBeDeposited) {
  // A site no wider than the wheel.
  heightfield::Ground ground = flat(dry_sand(), 6);
  Ruts ruts(ground);
  ruts.press({{twin_tyre(), loaded_at(0.3, 0.3, 44e3)}});
  EXPECT_GT(deepest(ground), 0.05);
  EXPECT_EQ(edges(ground).volume, 0);
  for (const std::int64_t change : ground.mass_change()) EXPECT_EQ(change, 0);
}

TEST(Ruts, OnlyColumnsUnderTheTyresChange) {
  heightfield::Ground ground = flat_loam();
  Ruts ruts(ground);
  ruts.press({{twin_tyre(), loaded_at(3.2, 3.2, 45e3)}});
  for (int iy = 0; iy < ground.ny(); ++iy)
    for (int ix = 0; ix < ground.nx(); ++ix) {
      const double dx = std::abs(0.1 * (ix + 0.5) - 3.2), dy = std::abs(0.1 * (iy + 0.5) - 3.2);
      // Twin tyres of 0.28 m at +-0.16 m; the longest chord of a 0.525 m tyre is below 0.6 m here.
      if (dx > 0.3 || dy > 0.31)
        EXPECT_EQ(ground.height(ix, iy), ground.start_height(ix, iy)) << ix << " " << iy;
    }
}

TEST(Ruts, AreLoadedAsTheyWereSavedOntoTheirSite) {
  heightfield::Ground ground = flat_loam();
  Ruts ruts(ground);
  ruts.press({{twin_tyre(), loaded_at(3.2, 3.2, 45e3)}});
  const std::vector<char> bytes = saved(ruts);
  Ruts again(ground);
  load_saved(bytes, again);
  EXPECT_EQ(hash_of(again).digest(), hash_of(ruts).digest());
  EXPECT_EQ(saved(again), bytes);
  EXPECT_EQ(test::flip_every_byte(ruts, again), "");
  heightfield::Ground corner = flat_loam(16);  // the wheel is beside it
  Ruts elsewhere(corner);
  EXPECT_THROW(load_saved(bytes, elsewhere), InputError);
}

}  // namespace
}  // namespace navvy::coupling
