// SPDX-License-Identifier: Apache-2.0
#include "coupling/ruts.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "core/saved_state.h"
#include "flip_bytes.h"

namespace navvy::coupling {
namespace {

heightfield::Ground flat_loam(int columns = 64) {
  heightfield::Ground::Setup setup;
  setup.nx = setup.ny = columns;
  setup.cell = 0.1;
  setup.datum = -2;
  setup.soils = {scene::Soil{}};
  setup.soils[0].name = "loam";
  setup.layers = {{"loam", 10}};
  setup.surface = [](int, int) { return 0.0; };
  return heightfield::Ground(std::move(setup));
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

TEST(Ruts, PressSinksTheTreadAndKeepsTheMass) {
  heightfield::Ground ground = flat_loam();
  Ruts ruts(ground);
  ruts.press(twin_tyre(), loaded_at(3.2, 3.2, 45e3));
  const double depth = deepest(ground);
  // A quarter of 18 t on loam: the plate law gives centimetres, less than a cell.
  EXPECT_GT(depth, 0.01);
  EXPECT_LT(depth, 0.10);
  for (const std::int64_t change : ground.mass_change()) EXPECT_EQ(change, 0);
}

TEST(Ruts, StandingStillAndAnEqualSecondPassAddNothingAHeavierOneDoes) {
  heightfield::Ground ground = flat_loam();
  Ruts ruts(ground);
  ruts.press(twin_tyre(), loaded_at(3.2, 3.2, 30e3));
  const double once = deepest(ground);
  for (int i = 0; i < 5; ++i) ruts.press(twin_tyre(), loaded_at(3.2, 3.2, 30e3));
  EXPECT_DOUBLE_EQ(deepest(ground), once);
  ruts.press(twin_tyre(), loaded_at(3.2, 3.2, 60e3));
  EXPECT_GT(deepest(ground), once);
}

TEST(Ruts, PressedALittleAtATimeEndsWhereOnePressDoes) {
  heightfield::Ground once = flat_loam(), slowly = flat_loam();
  Ruts(once).press(twin_tyre(), loaded_at(3.2, 3.2, 45e3));
  Ruts ruts(slowly);
  ruts.press(twin_tyre(), loaded_at(3.2, 3.2, 45e3), 0.002);
  // Columns keep whole mass quanta: heights are exact to a micrometre.
  EXPECT_NEAR(deepest(slowly), 0.002, 1e-6);
  for (int i = 0; i < 100; ++i) ruts.press(twin_tyre(), loaded_at(3.2, 3.2, 45e3), 0.002);
  EXPECT_NEAR(deepest(slowly), deepest(once), 1e-5);
}

TEST(Ruts, EndsRiseWithTheTreadInsteadOfAWall) {
  heightfield::Ground ground = flat_loam();
  Ruts ruts(ground);
  ruts.press(twin_tyre(), loaded_at(3.2, 3.2, 45e3));
  // Columns stand 0.05, 0.15, 0.25 m ahead; the tread leaves the ground between 0.2 and 0.3 m.
  const Vec2i at = ground.column_at(3.25, 3.35);
  const double middle = -ground.height(at.x(), at.y()), end = -ground.height(at.x() + 2, at.y());
  EXPECT_GT(middle, 0.01);
  EXPECT_GT(end, 0.2 * middle);
  EXPECT_LT(end, 0.8 * middle);
}

TEST(Ruts, OnlyColumnsUnderTheTyresChange) {
  heightfield::Ground ground = flat_loam();
  Ruts ruts(ground);
  ruts.press(twin_tyre(), loaded_at(3.2, 3.2, 45e3));
  for (int iy = 0; iy < ground.ny(); ++iy)
    for (int ix = 0; ix < ground.nx(); ++ix) {
      const double dx = std::abs(0.1 * (ix + 0.5) - 3.2), dy = std::abs(0.1 * (iy + 0.5) - 3.2);
      // Twin tyres of 0.28 m at +-0.16 m; the longest chord of a 0.525 m tyre is below 0.6 m here.
      if (dx > 0.3 || dy > 0.31) EXPECT_EQ(ground.height(ix, iy), ground.start_height(ix, iy)) << ix << " " << iy;
    }
}

TEST(Ruts, AreLoadedAsTheyWereSavedOntoTheSiteTheyLieOn) {
  heightfield::Ground ground = flat_loam();
  Ruts ruts(ground);
  ruts.press(twin_tyre(), loaded_at(3.2, 3.2, 45e3));
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
