// SPDX-License-Identifier: Apache-2.0
#include "formats/map_patch.h"

#include <gtest/gtest.h>

#include <cstring>
#include <vector>

#include "map/feeds.h"
#include "map/grounds.h"

namespace navvy::formats {
namespace {

TEST(MapPatch, IsSentInPiecesWhenLarge) {
  // More rows than a piece has.
  heightfield::Ground ground(map::testing::setup(70, 600));
  map::UpdateFeed feed(map::testing::two_layers());
  const map::UpdateFeed::Update first = feed.publish(ground.view());
  std::vector<char> sent;
  int pieces = 0;
  EXPECT_TRUE(send_patch(*first, map::testing::kTwo, [&](const char* bytes, std::size_t count) {
    sent.insert(sent.end(), bytes, bytes + count);
    return ++pieces > 0;
  }));
  EXPECT_EQ(pieces, 7) << "the header, and of each layer 256, 256 and 88 rows";
  const std::vector<float> slope = first->map.copy(map::MapLayer::kSlope);
  ASSERT_GT(sent.size(), slope.size() * 2 * sizeof(float));
  EXPECT_EQ(std::memcmp(sent.data() + sent.size() - slope.size() * sizeof(float), slope.data(),
                        slope.size() * sizeof(float)),
            0);
  int until = 3;
  EXPECT_FALSE(send_patch(*first, map::testing::kTwo,
                          [&](const char*, std::size_t) { return --until > 0; }));
  EXPECT_EQ(until, 0) << "ends on request";
}

}  // namespace
}  // namespace navvy::formats
