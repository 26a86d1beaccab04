// SPDX-License-Identifier: Apache-2.0
// Sites on which a job is done in part: volumes, masses, slopes, and refusals.
#include "earthwork/part_done.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "control/dig_rig.h"
#include "control/ew180_like.h"
#include "control/reach.h"
#include "core/error.h"
#include "earthwork/pit_planner.h"

namespace navvy::earthwork {
namespace {

control::PitJob pit(double length, double width, double depth) {
  const double a = 0.5 * length, b = 0.5 * width;
  control::PitJob out;
  // So far ahead that all stations are on the site of the test.
  out.area.polygon = {{2 - a, -b}, {2 + a, -b}, {2 + a, b}, {2 - a, b}};
  out.area.depth = depth;
  out.area.batter = radians(45);
  out.dump_from = Vec2(-8, 6.4);
  out.dump_to = Vec2(1, 6.4);
  return out;
}

const Pose kStart = make_pose(-8.5, 0, 0);

PartDone done(double share, std::uint64_t seed, heightfield::Ground& ground,
              const control::PitJob& job = pit(4, 3, 1),
              const std::vector<heightfield::OccupiedArea>& areas = {}) {
  return stage(job, control::testing::ew180_like(), kStart, share, seed, areas, ground);
}

/// Volumes by which columns are lower and higher than at the start [m3].
struct Change {
  double cut = 0, fill = 0;
};
Change change_of(const heightfield::Ground& ground) {
  Change out;
  for (int iy = 0; iy < ground.ny(); ++iy)
    for (int ix = 0; ix < ground.nx(); ++ix) {
      const double rise = ground.height(ix, iy) - ground.start_height(ix, iy);
      (rise < 0 ? out.cut : out.fill) += std::abs(rise) * ground.cell() * ground.cell();
    }
  return out;
}

TEST(PartDone, HasTheWantedVolumeAndKeepsTheMassExactly) {
  for (const double share : {0.25, 0.5, 0.75}) {
    heightfield::Ground ground = control::testing::flat_ground();
    const std::vector<std::int64_t> mass = ground.mass_change();
    const PartDone out = done(share, 0, ground);
    EXPECT_NEAR(out.share, share, 0.001);
    EXPECT_EQ(ground.mass_change(), mass);
    const Change change = change_of(ground);
    EXPECT_NEAR(change.cut, out.volume, 1e-4 * out.volume);
    const double swell = ground.setup().soils[0].swell;
    EXPECT_NEAR(change.fill, swell * out.volume, 1e-3 * out.volume);
    // The planner of the rest sees what is left.
    const auto planner = job_planners()(control::testing::ew180_like());
    const control::GroundSurfaceView surface(ground);
    const control::JobVolume volume = planner->volume(pit(4, 3, 1), surface);
    EXPECT_NEAR(volume.left, (1 - share) * volume.design, 0.01 * volume.design);
  }
}

TEST(PartDone, LeavesSlopesAtWhichSoilIsAtRest) {
  heightfield::Ground ground = control::testing::flat_ground();
  done(0.5, 7, ground);
  const double repose = std::tan(ground.setup().soils[0].friction_angle);
  double steepest_spoil = 0, steepest_cut = 0;
  for (int iy = 1; iy + 1 < ground.ny(); ++iy)
    for (int ix = 1; ix + 1 < ground.nx(); ++ix) {
      const double fall = std::max(std::abs(ground.height(ix + 1, iy) - ground.height(ix, iy)),
                                   std::abs(ground.height(ix, iy + 1) - ground.height(ix, iy))) /
                          ground.cell();
      double& steepest = ground.height(ix, iy) > ground.start_height(ix, iy) + 0.01 ? steepest_spoil
                                                                                    : steepest_cut;
      steepest = std::max(steepest, fall);
    }
  EXPECT_LT(steepest_spoil, repose);
  // Sides and face of 1:1; the bend of the face adds a little.
  EXPECT_LT(steepest_cut, 1.45);
  EXPECT_GT(steepest_cut, 0.9);
}

TEST(PartDone, RepeatsForEqualSeedsAndDiffersForOthers) {
  const auto heights = [](std::uint64_t seed) {
    heightfield::Ground ground = control::testing::flat_ground();
    done(0.5, seed, ground);
    std::vector<double> out;
    for (int iy = 0; iy < ground.ny(); ++iy)
      for (int ix = 0; ix < ground.nx(); ++ix) out.push_back(ground.height(ix, iy));
    return out;
  };
  EXPECT_EQ(heights(1), heights(1));
  EXPECT_NE(heights(1), heights(2));
}

TEST(PartDone, RefusesWhatCannotBeAndChangesNothing) {
  const auto refused = [](double share, const control::PitJob& job,
                          const std::vector<heightfield::OccupiedArea>& areas = {}) -> std::string {
    heightfield::Ground ground = control::testing::flat_ground();
    try {
      done(share, 0, ground, job, areas);
    } catch (const InputError& error) {
      EXPECT_EQ(ground.touched_tiles(), 0u);
      return error.what();
    }
    return "";
  };
  for (const double share : {0.0, 1e-300, -1.0, 1.5, std::nan("")})
    EXPECT_NE(refused(share, pit(4, 3, 1)).find("from 0.01 to 1"), std::string::npos);
  // A body in the pit, and one under the spoil.
  for (const Vec3& at : {Vec3(3, 0, 0), Vec3(1, 6.4, 0)}) {
    const heightfield::OccupiedArea body =
        heightfield::area_around({at, at + Vec3(0.5, 0, 0.5), at + Vec3(0, 0.5, 0.5)}, true);
    EXPECT_NE(refused(0.9, pit(4, 3, 1), {body}).find("a body stands"), std::string::npos);
  }
  control::PitJob job = pit(4, 3, 1);
  job.dump_from = job.dump_to = Vec2(-4, 3.2);
  EXPECT_NE(refused(1, job).find("would be in the pit"), std::string::npos) << refused(1, job);
  job.dump_from = job.dump_to = Vec2(-60, 3);
  EXPECT_NE(refused(0.5, job).find("dump"), std::string::npos) << refused(0.5, job);
}

}  // namespace
}  // namespace navvy::earthwork
