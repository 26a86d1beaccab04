// SPDX-License-Identifier: Apache-2.0
// The map that a machine makes from its own scans.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "sensor/digging_bucket.h"
#include "sensor/ray_scene.h"
#include "sensor/scenes.h"
#include "session/session.h"
#include "sim/world_terrain.h"

namespace navvy::sensor {
namespace {

using testing::digging_bucket;
using testing::mast;
using testing::scene_of;
using testing::world_of;

constexpr double kSigma = 0.01;  // [m] of a distance

/// Returns a scanner with 81 rings that look down from 2 m, and a map of what it sees with cells of
/// 0.1 m from (0.5, -2) to (7, 2).
std::string scanner_and_map() {
  return R"(<sensor name="scanner" type="lidar"><pose>0 0 1.9 0 0 0</pose><update_rate>20</update_rate>
<lidar><scan><horizontal><samples>161</samples><min_angle>-0.5</min_angle><max_angle>0.5</max_angle>
</horizontal><vertical><samples>81</samples><min_angle>-1.2</min_angle><max_angle>-0.25</max_angle>
</vertical></scan><range><min>0.05</min><max>15</max></range><noise><type>gaussian</type>
<stddev>0.01</stddev></noise></lidar></sensor>
<sensor name="map" type="navvy:map"><update_rate>10</update_rate><navvy:map><cell_m>0.1</cell_m>
<min_m>0.5 -2</min_m><max_m>7 2</max_m></navvy:map></sensor>)";
}

TEST(OwnMap, ShowsWhatIsVisibleWithinTheNoiseAndNothingElse) {
  device::Device device;
  // The near wall hides the near half of the floor: from 2 m above the ground, 2 m away.
  const auto world = world_of(
      scene_of(mast(scanner_and_map()),
               "<trench><center_m>3 0</center_m><yaw_deg>90</yaw_deg><length_m>12</length_m>"
               "<width_m>2</width_m><depth_m>1</depth_m></trench>"),
      device);
  while (world->time() < 0.5) world->step();
  const auto view = world->arrays().view("mast/map/elevation");
  ASSERT_EQ(view.channel().type_text(), "float32[40,65]");
  const auto seen = view.values<float>();
  double squares = 0;
  int known = 0, hidden = 0;
  for (int iy = 15; iy < 25; ++iy)
    for (int ix = 0; ix < 65; ++ix) {
      const double x = 0.55 + 0.1 * ix,
                   z = static_cast<double>(seen[static_cast<std::size_t>(ix + 65 * iy)]);
      if (x > 2.2 && x < 2.75) {
        EXPECT_TRUE(std::isnan(z)) << x;
        ++hidden;
      }
      // Level cells only: at the walls a cell holds points of all heights.
      const bool floor = x > 3.25 && x < 3.75, surface = (x > 1 && x < 1.8) || (x > 4.3 && x < 6.5);
      if ((!floor && !surface) || std::isnan(z)) continue;
      squares += std::pow(z - (floor ? -1 : 0), 2);
      ++known;
    }
  EXPECT_GT(hidden, 40);
  EXPECT_GT(known, 200);
  EXPECT_LT(std::sqrt(squares / known), 2 * kSigma);
  const auto score = world->arrays().view("mast/map/score").values<double>();
  EXPECT_GT(score[0], 0.3);
  EXPECT_LT(score[0], 0.95);
  // At the walls a cell of 0.1 m is up to 1 m off.
  EXPECT_GT(score[1], 0);
  EXPECT_LT(score[1], 0.3);
  // No bucket has passed, so the prediction is what was seen.
  const auto predicted = world->arrays().view("mast/map/predicted").values<float>();
  for (std::size_t i = 0; i < seen.size(); ++i)
    if (!std::isnan(seen[i])) ASSERT_EQ(predicted[i], seen[i]);
}

TEST(OwnMap, LeavesOutTheMachineItselfUnlessAskedNotTo) {
  device::Device device;
  // A plate of the mast's own, and one of another body: both 0.6 m high, side by side.
  const auto height_at = [&](const std::string& of_map, double y) {
    std::string sensors = scanner_and_map();
    sensors.insert(sensors.find("<cell_m>"), of_map);
    const auto world = world_of(
        scene_of(
            mast("<visual name=\"arm\"><pose>2 0.75 0.2 0 0 0</pose><geometry><box><size>0.5 0.5 "
                 "0.6</size></box></geometry></visual>" +
                 sensors) +
            testing::body("other", "2 -0.75 0.3 0 0 0", "<box><size>0.5 0.5 0.6</size></box>")),
        device);
    while (world->time() < 0.2) world->step();
    const auto seen = world->arrays().view("mast/map/elevation").values<float>();
    // The cell in the middle of a plate, 2 m ahead.
    return static_cast<double>(
        seen[static_cast<std::size_t>(14 + 65 * static_cast<int>(std::floor((y + 2) / 0.1)))]);
  };
  EXPECT_TRUE(std::isnan(height_at("", 0.75))) << "the machine is filtered by default";
  EXPECT_NEAR(height_at("<self_filter>false</self_filter>", 0.75), 0.6, 3 * kSigma);
  for (const char* filter : {"", "<self_filter>false</self_filter>"})
    EXPECT_NEAR(height_at(filter, -0.75), 0.6, 3 * kSigma) << "others are seen";
}

/// Returns the digging bucket with a scanner behind and above it, and a map of what it sees.
std::string bucket_with_map() {
  return digging_bucket(R"(<navvy:sensor name="scanner" link="base" type="lidar">
<pose>-3 0 2.2 0 0 0</pose><update_rate>20</update_rate><lidar><scan><horizontal>
<samples>181</samples><min_angle>-0.6</min_angle><max_angle>0.6</max_angle></horizontal><vertical>
<samples>121</samples><min_angle>-1.2</min_angle><max_angle>-0.3</max_angle></vertical></scan>
<range><min>0.05</min><max>15</max></range><noise><type>gaussian</type><stddev>0.01</stddev></noise>
</lidar></navvy:sensor><navvy:sensor name="map" link="base" type="navvy:map">
<update_rate>20</update_rate><navvy:map><cell_m>0.1</cell_m><min_m>-2.5 -1.5</min_m>
<max_m>2 1.5</max_m></navvy:map></navvy:sensor>)");
}

/// Errors of a map of 45 x 30 cells of 0.1 m from (-2.5, -1.5).
struct MapErrors {
  int count = 0;
  double squares = 0, bounds = 0;

  void add(double error, double bound) {
    ++count;
    squares += error * error;
    bounds += bound * bound;
  }
  double rms() const { return std::sqrt(squares / count); }
  double rms_bound() const { return std::sqrt(bounds / count); }
};

/// Returns which cells of the map a beam of the scanner meets on the ground at this instant, but
/// for those within 0.5 m of the bucket: the map leaves out points on it and on the soil that it
/// holds.
std::vector<bool> visible_cells(const sim::World& world) {
  RayScene scene(world);
  scene.update();
  const auto scan = world.arrays().view("bucket/scanner/ranges");
  std::vector<bool> out(45 * 30, false);
  for (int ring = 0; ring < 121; ++ring)
    for (int beam = 0; beam < 181; ++beam) {
      const double up = -1.2 + 0.9 * ring / 120, left = -0.6 + 1.2 * beam / 180;
      const Vec3 d(std::cos(up) * std::cos(left), std::cos(up) * std::sin(left), std::sin(up));
      const Vec3 p = scan.X_WF().translation(), d_W = scan.X_WF().linear() * d;
      const auto hit = scene.first_hit(p, d_W, 15);
      if (!hit || hit->what != Met::kGround) continue;
      const Vec3 q = p + hit->distance * d_W;
      if (scene.on_machine(0, q, 0.5)) continue;
      const int ix = static_cast<int>(std::floor((q.x() + 2.5) / 0.1)),
                iy = static_cast<int>(std::floor((q.y() + 1.5) / 0.1));
      if (ix >= 0 && iy >= 0 && ix < 45 && iy < 30)
        out[static_cast<std::size_t>(ix + 45 * iy)] = true;
    }
  return out;
}

/// Returns the difference of the highest and the lowest ground within half a cell around a place.
double relief(const heightfield::TerrainView& ground, double x, double y) {
  double low = ground.sample(x, y), high = low;
  for (int i = 0; i < 9; ++i) {
    const int column = i % 3 - 1, row = i / 3 - 1;
    const double z = ground.sample(x + 0.05 * column, y + 0.05 * row);
    low = std::min(low, z);
    high = std::max(high, z);
  }
  return high - low;
}

TEST(OwnMap, PredictsWhatABucketHasCutWhereItHidesTheGround) {
  device::Device device;
  session::Session session(scene_of(bucket_with_map()), device);
  for (auto& one : make_sensors(session.world())) session.add(std::move(one));
  const sim::World& world = session.world();
  int instants = 0;
  // From the cut through the drag to the end of the curl, when the bucket is out of the ground.
  for (double time = 2.25; time < 4.6; time += 0.25) {
    while (world.time() < time - 1e-9) session.step();
    const auto seen = world.arrays().view("bucket/map/elevation").values<float>(),
               predicted = world.arrays().view("bucket/map/predicted").values<float>();
    const heightfield::TerrainView truth =
        sim::terrain_view(world, heightfield::SurfaceKind::kMapped);
    const std::vector<bool> visible = visible_cells(world);
    MapErrors of_visible, of_hidden, of_old;
    for (int iy = 0; iy < 30; ++iy)
      for (int ix = 0; ix < 45; ++ix) {
        const auto i = static_cast<std::size_t>(ix + 45 * iy);
        const double x = -2.45 + 0.1 * ix, y = -1.45 + 0.1 * iy, z = truth.sample(x, y);
        ASSERT_EQ(std::isnan(seen[i]), std::isnan(predicted[i]));
        if (std::isnan(seen[i])) continue;
        if (visible[i]) of_visible.add(seen[i] - z, 2 * kSigma + 0.5 * relief(truth, x, y));
        if (predicted[i] == seen[i]) continue;
        // Only steel changes the prediction, and it only cuts.
        EXPECT_LT(predicted[i], seen[i]);
        of_hidden.add(predicted[i] - z, 0.05);
        of_old.add(seen[i] - z, 0);
      }
    // The bounds of the issue: two deviations and half a cell of slope, and 5 cm.
    EXPECT_GT(of_visible.count, 500) << time;
    EXPECT_LT(of_visible.rms(), of_visible.rms_bound()) << time;
    ASSERT_GT(of_hidden.count, 10) << time;
    EXPECT_LT(of_hidden.rms(), 0.05) << time;
    // Without the prediction the map shows ground that is long gone.
    EXPECT_GT(of_old.rms(), 0.15) << time;
    ++instants;
  }
  EXPECT_EQ(instants, 10);
}

}  // namespace
}  // namespace navvy::sensor
