// SPDX-License-Identifier: Apache-2.0
#include "soil/particles/block_table.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace navvy::soil {
namespace {

TEST(BlockTable, NeighboursAndSurroundingsAgree) {
  std::vector<BlockKey> particle_blocks = {{5, -3, 2}, {6, -3, 2}, {100000, 7, -1}, {-4, -4, -4}};
  std::sort(particle_blocks.begin(), particle_blocks.end());
  BlockTable table;
  table.build(particle_blocks);
  EXPECT_EQ(table.active.size(), 27u + 9u + 27u + 27u);
  EXPECT_TRUE(std::is_sorted(table.active.begin(), table.active.end()));
  for (std::size_t h = 0; h < table.particle_blocks.size(); ++h)
    for (int n = 0; n < 27; ++n) {
      const int active = table.neighbours[27 * h + static_cast<std::size_t>(n)];
      ASSERT_GE(active, 0);
      EXPECT_EQ(table.active[static_cast<std::size_t>(active)],
                table.particle_blocks[h] + neighbour_offset(n));
    }
  for (std::size_t b = 0; b < table.active.size(); ++b)
    for (int n = 0; n < 27; ++n)
      EXPECT_EQ(table.around[27 * b + static_cast<std::size_t>(n)],
                table.particle_block_index.find(table.active[b] + neighbour_offset(n)));
}

TEST(BlockTable, MayBeEmpty) {
  BlockTable table;
  table.build({});
  EXPECT_TRUE(table.active.empty());
  EXPECT_EQ(table.particle_block_index.find({0, 0, 0}), -1);
}

TEST(BlockTable, SizeFollowsBlocksNotTheirDistance) {
  BlockTable table;
  table.build({{-1000000, 0, 0}, {1000000, 0, 0}});
  EXPECT_EQ(table.active.size(), 54u);
  EXPECT_EQ(table.active_index.find({999999, 1, 1}), 51);
}

}  // namespace
}  // namespace navvy::soil
