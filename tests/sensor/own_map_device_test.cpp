// SPDX-License-Identifier: Apache-2.0
// The map that a machine makes from its own scans.
#include <gtest/gtest.h>

#include <cmath>

#include "sensor/scenes.h"

namespace navvy::sensor {
namespace {

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

}  // namespace
}  // namespace navvy::sensor
