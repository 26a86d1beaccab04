// SPDX-License-Identifier: Apache-2.0
// Formats for planners show a body that stands on free ground as occupied.
#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/file.h"
#include "folder.h"
#include "formats/formats.h"
#include "formats/ros/messages.h"
#include "heightfield/occupied_area.h"
#include "map/grounds.h"

namespace navvy::formats {
namespace {

constexpr int kNx = 40, kNy = 24;

/// Returns the map of flat ground with a wall over the columns 20 to 22 of the rows 4 to 9.
map::TerrainMap walled() {
  const heightfield::GroundSetup s = map::testing::setup(kNx, kNy);
  const Vec2 low = map::testing::centre(s, 20, 4), high = map::testing::centre(s, 22, 9);
  std::vector<Vec3> corners;
  corners.reserve(8);
  for (int i = 0; i < 8; ++i)
    corners.emplace_back((i & 1) != 0 ? high.x() : low.x(), (i & 2) != 0 ? high.y() : low.y(),
                         (i & 4) != 0 ? 1.5 : -0.2);
  const std::vector<heightfield::OccupiedArea> areas = {heightfield::area_around(corners, false)};
  map::MapOptions options;
  options.layers = {map::MapLayer::kElevation, map::MapLayer::kTraversability};
  map::MapMaker maker(options);
  maker.update(heightfield::Ground(s).view().with(
      std::make_shared<const std::vector<heightfield::OccupiedArea>>(areas)));
  return maker.map();
}

/// Returns 100 for a column under the wall, else 0, as OccupancyGrid counts.
int expected(int ix, int iy) { return ix >= 20 && ix <= 22 && iy >= 4 && iy <= 9 ? 100 : 0; }

TEST(OccupiedFormats, Nav2HasBlackPixelsUnderAWallAndFreeOnesBesideIt) {
  const test::Folder folder;
  write_map("nav2", walled(), {map::MapLayer::kTraversability}, folder / "map.yaml");
  const std::vector<char> pgm = read_file(folder / "map.pgm");
  const std::string head = "P5\n40 24\n255\n";
  ASSERT_EQ(pgm.size(), head.size() + kNx * kNy);
  for (int y = 0; y < kNy; ++y)
    for (int ix = 0; ix < kNx; ++ix) {
      const auto pixel =
          static_cast<std::uint8_t>(pgm[head.size() + static_cast<std::size_t>(y * kNx + ix)]);
      // Row 0 of the picture has the greatest y.
      ASSERT_EQ(pixel, expected(ix, kNy - 1 - y) == 100 ? 0 : 254) << ix << " " << y;
    }
}

TEST(OccupiedFormats, OccupancyGridIsFullUnderAWallAndFreeBesideIt) {
  const ros::Bytes message = ros::occupancy_grid(walled(), 0);
  ASSERT_GT(message.size(), static_cast<std::size_t>(kNx * kNy));
  // The cells end the message.
  const auto* cells = reinterpret_cast<const std::int8_t*>(message.data()) + message.size() -
                      static_cast<std::size_t>(kNx * kNy);
  for (int iy = 0; iy < kNy; ++iy)
    for (int ix = 0; ix < kNx; ++ix)
      ASSERT_EQ(cells[iy * kNx + ix], expected(ix, iy)) << ix << " " << iy;
}

}  // namespace
}  // namespace navvy::formats
