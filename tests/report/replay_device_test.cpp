// SPDX-License-Identifier: Apache-2.0
// The page of a run shows the run: heights, poses and forces at the times of its frames.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "folder.h"
#include "report/page.h"
#include "report/pages.h"
#include "run/scene.h"
#include "run/simulation.h"
#include "sim/world_terrain.h"

namespace navvy::report {
namespace {

using nlohmann::json;
using testing::data_of;
using testing::heights_at;
using testing::unpacked;

/// What the world was at the time of a frame.
struct Moment {
  std::vector<double> heights;  ///< of a map [m]
  Vec3 bucket = Vec3::Zero();   ///< place of the link "bucket"
  Vec3 force = Vec3::Zero();    ///< filtered force on the bucket [N]
};

Moment moment_of(const sim::World& world) {
  Moment out;
  const heightfield::TerrainView view = sim::terrain_view(world, heightfield::SurfaceKind::kMapped);
  for (int iy = 0; iy < view.ny(); ++iy)
    for (int ix = 0; ix < view.nx(); ++ix) out.heights.push_back(view.height(ix, iy));
  const sim::MachineHandle machine = world.machines().at("bucket");
  out.bucket = machine.link("bucket").pose().translation();
  out.force = machine.tool("bucket").smooth_force();
  return out;
}

TEST(Replay, ShowsHeightsPosesAndForcesOfTheRun) {
  const test::Folder folder;
  run::SimulationOptions options;
  options.folder = folder.path().string() + "/run";
  std::map<int, Moment> moments;  // by tenths of a second
  double half_step = 0;           // frames are at the nearest base step [s]
  {
    run::Simulation simulation(run::test::bucket_scene(4), options);
    half_step = 0.5 * simulation.world().dt() + 1e-9;
    run::LoopHooks hooks;
    hooks.progress = [&](const run::RunProgress& progress) {
      const int tenth = static_cast<int>(std::lround(10 * progress.time));
      const bool wanted = tenth == 10 || tenth == 24 || tenth == 38;
      if (wanted && std::abs(progress.time - 0.1 * tenth) < 0.5 * simulation.world().dt())
        moments.emplace(tenth, moment_of(simulation.world()));
    };
    simulation.run_to_end(hooks);
  }
  ASSERT_EQ(moments.size(), 3u);
  const std::string file = folder / "page.html";
  write_page({options.folder}, file);
  const json one = data_of(test::text_of(file)).at("runs").at(0);
  const json& times = one.at("frames").at("times");
  ASSERT_EQ(times.size(), 21u);
  std::size_t bucket = 0;
  while (one.at("links").at(bucket).at("link") != "bucket") ++bucket;
  const std::size_t links = one.at("links").size();
  const auto poses = unpacked<float>(one.at("frames").at("poses"));
  const auto forces = unpacked<float>(one.at("frames").at("forces"));
  ASSERT_EQ(poses.size(), times.size() * links * 7);
  ASSERT_EQ(forces.size(), times.size() * 6);
  double moved = 0, largest = 0;
  for (const auto& [tenth, moment] : moments) {
    const auto frame = static_cast<std::size_t>(tenth / 2);
    EXPECT_NEAR(times[frame].get<double>(), 0.1 * tenth, half_step);
    const std::vector<double> shown = heights_at(one, 0.1 * tenth + half_step);
    ASSERT_EQ(shown.size(), moment.heights.size());
    const std::vector<double> start = heights_at(one, -1);
    for (std::size_t i = 0; i < shown.size(); ++i) {
      EXPECT_NEAR(shown[i], moment.heights[i], 0.00051) << tenth << ' ' << i;
      moved = std::max(moved, std::abs(shown[i] - start[i]));
    }
    for (Eigen::Index k = 0; k < 3; ++k) {
      const auto at = static_cast<std::size_t>(k);
      EXPECT_NEAR(static_cast<double>(poses[(frame * links + bucket) * 7 + at]), moment.bucket[k],
                  1e-5);
      EXPECT_NEAR(static_cast<double>(forces[frame * 6 + 3 + at]), moment.force[k], 1);
    }
    largest = std::max(largest, moment.force.norm());
  }
  EXPECT_GT(moved, 0.1) << "nothing was dug";
  EXPECT_GT(largest, 1000);
  const auto particles = unpacked<std::uint16_t>(one.at("frames").at("particle_counts"));
  EXPECT_GT(particles.at(19), 50u) << "the bucket holds soil";
  for (const std::uint16_t count : particles) EXPECT_LE(count, 501u);
}

TEST(Replay, IsLeftOutIfNotWanted) {
  const test::Folder folder;
  run::SimulationOptions options;
  options.folder = folder.path().string() + "/run";
  options.replay = false;
  run::Simulation(run::test::bucket_scene(0.1), options).run_to_end({});
  EXPECT_FALSE(std::filesystem::exists(options.folder + "/replay.jsonl"));
  EXPECT_TRUE(std::filesystem::exists(options.folder + "/telemetry.csv"));
}

}  // namespace
}  // namespace navvy::report
