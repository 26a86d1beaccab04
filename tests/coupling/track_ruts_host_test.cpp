// SPDX-License-Identifier: Apache-2.0
#include "coupling/track_ruts.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/saved_state.h"
#include "terramechanics/plate.h"

namespace navvy::coupling {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

heightfield::Ground flat_loam(double multi_pass_exponent = 0) {
  scene::Soil loam;
  loam.name = "loam";
  loam.multi_pass_exponent = multi_pass_exponent;
  heightfield::Ground::Setup setup;
  setup.nx = setup.ny = 64;
  setup.cell = 0.1;
  setup.datum = -2;
  setup.soils = {loam};
  setup.layers = {{loam.name, 10}};
  setup.surface = [](int, int) { return 0.0; };
  return heightfield::Ground(std::move(setup));
}

/// 0.4 m of a track of 0.6 m under `load` [N].
terramechanics::TrackPatch patch_at(double x, double y, double load) {
  return {Vec3(x, y, 0), Vec3::UnitX(), 0.4, 0.6, load};
}

TEST(TrackRuts, PressByThePlateLawAndOnlyOnce) {
  heightfield::Ground ground = flat_loam();
  Ruts tyres(ground);
  TrackRuts ruts(ground, tyres);
  const double pressure = 12e3 / (0.4 * 0.6);
  const double z = terramechanics::plate_sinkage(ground.setup().soils[0], pressure, 0.6);
  for (int pass = 0; pass < 3; ++pass) {
    ruts.press({patch_at(3.2, 3.2, 12e3)}, kFar, true);
    const Vec2i at = ground.column_at(3.2, 3.2), beside = ground.column_at(3.2, 3.8);
    EXPECT_NEAR(ground.height(at.x(), at.y()), -z, 1e-4);
    EXPECT_NEAR(ground.height(beside.x(), beside.y()), 0, 1e-6);
    EXPECT_TRUE(ground.held(at.x(), at.y()));
  }
  // A lighter one adds nothing, a heavier one its additional sinkage.
  ruts.press({patch_at(3.2, 3.2, 6e3)}, kFar, true);
  const Vec2i at = ground.column_at(3.2, 3.2);
  EXPECT_NEAR(ground.height(at.x(), at.y()), -z, 1e-4);
  ruts.press({patch_at(3.2, 3.2, 24e3)}, kFar, true);
  EXPECT_NEAR(ground.height(at.x(), at.y()),
              -terramechanics::plate_sinkage(ground.setup().soils[0], 2 * pressure, 0.6), 2e-4);
  // Soil is compacted, not lost.
  for (const std::int64_t mass : ground.mass_change()) EXPECT_EQ(mass, 0);
}

TEST(TrackRuts, RaiseTheirEdgesByTheLoadTheGroundCannotSupport) {
  heightfield::Ground ground = flat_loam();
  Ruts tyres(ground);
  TrackRuts ruts(ground, tyres);
  const Vec2i under = ground.column_at(3.2, 3.25), beside = ground.column_at(3.2, 3.55);
  const double before = ground.height(beside.x(), beside.y());
  // The loam supports 50 kPa as a foundation, but not 0.5 MPa.
  ruts.press({patch_at(3.2, 3.2, 12e3)}, kFar, true);
  EXPECT_EQ(ground.height(beside.x(), beside.y()), before);
  ruts.press({patch_at(3.2, 3.2, 120e3)}, kFar, true);
  EXPECT_GT(ground.height(beside.x(), beside.y()), before + 0.01);
  EXPECT_GT(ground.specific_volume(beside.x(), beside.y()), 1.2f);  // loose
  // However much soil is displaced, it sinks by Bekker's law.
  EXPECT_NEAR(ground.height(under.x(), under.y()),
              -terramechanics::plate_sinkage(ground.setup().soils[0], 120e3 / 0.24, 0.6), 1e-3);
  for (const std::int64_t mass : ground.mass_change()) EXPECT_EQ(mass, 0);
}

TEST(TrackRuts, DeepenRutsOfTyresOnlyByTheDifferenceAndViceVersa) {
  // Wheels and tracks in one lane: the deeper rut of both remains, in either order.
  scene::Wheel wheel;
  vehicle::WheelState under_load;
  under_load.X_WWheel.translation() = Vec3(3.2, 3.2, 0.5);
  under_load.force_W = Vec3(0, 0, 20e3);
  const auto depth = [&](const std::vector<bool>& track_first) {
    heightfield::Ground ground = flat_loam();
    Ruts tyres(ground);
    TrackRuts running_tracks(ground, tyres);
    for (const bool running_track : track_first)
      if (running_track)
        running_tracks.press({patch_at(3.2, 3.2, 12e3)}, kFar, true);
      else
        tyres.press({{wheel, under_load}});
    const Vec2i at = ground.column_at(3.2, 3.2);
    return -ground.height(at.x(), at.y());
  };
  const double running_track = depth({true}), tyre = depth({false});
  EXPECT_GT(tyre, 1.5 * running_track);
  // Plates of two widths: a pressure is remembered, and sinks the wider one a little more.
  EXPECT_NEAR(depth({true, false}), tyre, 0.02 * tyre);
  EXPECT_NEAR(depth({false, true}), tyre, 0.02 * tyre);
}

TEST(TrackRuts, AddNothingToRepeatedPassesOfTyres) {
  // With the exponent 0, too, the larger depth remains.
  for (const double exponent : {0.0, 2.5}) {
    heightfield::Ground ground = flat_loam(exponent);
    Ruts tyres(ground);
    TrackRuts ruts(ground, tyres);
    const Vec2i at = ground.column_at(3.2, 3.2);
    const auto depth = [&] { return -ground.height(at.x(), at.y()); };
    vehicle::WheelState here, away;
    here.X_WWheel.translation() = Vec3(3.2, 3.2, 0.5);
    away.X_WWheel.translation() = Vec3(5.6, 5.6, 0.5);
    here.force_W = away.force_W = Vec3(0, 0, 20e3);
    tyres.press({{scene::Wheel{}, here}});
    const double once = depth();
    tyres.press({{scene::Wheel{}, away}});
    tyres.press({{scene::Wheel{}, here}});
    const double twice = depth();
    // 2^(1/2.5) = 1.32.
    EXPECT_NEAR(twice, exponent > 0 ? 1.32 * once : once, 0.02 * once);
    const auto press = [&](double sinkage) {
      const scene::Soil& soil = ground.setup().soils[0];
      const double pressure = terramechanics::plate_pressure(soil, sinkage, 0.6);
      ruts.press({patch_at(3.2, 3.2, pressure * 0.4 * 0.6)}, kFar, true);
    };
    // Deeper than the first pass, less deep than both: on top of the first it would reach 1.42.
    if (exponent > 0) {
      press(1.15 * once);
      EXPECT_EQ(depth(), twice);
    }
    press(1.6 * once);
    EXPECT_NEAR(depth(), 1.6 * once, 0.02 * once);
  }
}

TEST(TrackRuts, HoldTheRecordsOfTyresToo) {
  heightfield::Ground ground = flat_loam();
  Ruts tyres(ground);
  TrackRuts ruts(ground, tyres);
  const Vec2i tyre = ground.column_at(1, 1), running_track = ground.column_at(3.2, 3.2);
  ground.hold({static_cast<std::int64_t>(tyre.y()) * ground.nx() + tyre.x()});
  ruts.press({patch_at(3.2, 3.2, 12e3)}, kFar, false);
  EXPECT_TRUE(ground.held(tyre.x(), tyre.y()));
  EXPECT_TRUE(ground.held(running_track.x(), running_track.y()));
  ruts.press({}, kFar, true);
  EXPECT_FALSE(ground.held(running_track.x(), running_track.y()));
}

TEST(TrackRuts, YieldNoFasterThanTheLimit) {
  heightfield::Ground ground = flat_loam();
  Ruts tyres(ground);
  TrackRuts ruts(ground, tyres);
  const Vec2i at = ground.column_at(3.2, 3.2);
  ruts.press({patch_at(3.2, 3.2, 12e3)}, 0.002, true);
  EXPECT_NEAR(ground.height(at.x(), at.y()), -0.002, 1e-5);
  for (int i = 0; i < 20; ++i) ruts.press({patch_at(3.2, 3.2, 12e3)}, 0.002, true);
  const double z = terramechanics::plate_sinkage(ground.setup().soils[0], 12e3 / 0.24, 0.6);
  EXPECT_NEAR(ground.height(at.x(), at.y()), -z, 2e-4);
}

TEST(TrackRuts, AreRestoredFromASnapshot) {
  heightfield::Ground ground = flat_loam();
  Ruts tyres(ground), tyres_resumed(ground);
  TrackRuts ruts(ground, tyres), resumed(ground, tyres_resumed);
  ruts.press({patch_at(3.2, 3.2, 12e3)}, kFar, true);
  load_saved(saved(tyres), tyres_resumed);
  const Vec2i at = ground.column_at(3.2, 3.2);
  const double height = ground.height(at.x(), at.y());
  resumed.press({patch_at(3.2, 3.2, 12e3)}, kFar, true);
  EXPECT_EQ(ground.height(at.x(), at.y()), height);
}

}  // namespace
}  // namespace navvy::coupling
