// SPDX-License-Identifier: Apache-2.0
#include "map/update_feed.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstring>
#include <set>
#include <thread>
#include <utility>

#include "core/hash.h"
#include "core/random.h"
#include "map/cut_and_fill.h"
#include "map/feeds.h"
#include "map/grounds.h"
#include "map/map_queries.h"
#include "planner/footprint.h"

namespace navvy::map {
namespace {

using heightfield::Ground;
using testing::dig;
using testing::two_layers;

bool same(const TerrainMap& a, const TerrainMap& b) { return count_changed(a, b) == 0; }

/// Applies an update to a reader's copy.
void apply(const MapUpdate& update, std::vector<float>& mine, MapLayer layer) {
  const TerrainMap& map = update.map;
  if (mine.empty()) mine.assign(static_cast<std::size_t>(map.rect().area()), kUnknown);
  for (const heightfield::CellRect& r : update.rects)
    for (int iy = r.y0; iy < r.y1; ++iy)
      for (int ix = r.x0; ix < r.x1; ++ix)
        mine[static_cast<std::size_t>(iy) * static_cast<std::size_t>(map.nx()) +
             static_cast<std::size_t>(ix)] = map.at(layer, ix, iy);
}

TEST(UpdateFeed, NumbersChangesOnly) {
  Ground ground(testing::setup(70, 66));
  UpdateFeed feed(two_layers());
  EXPECT_EQ(feed.latest(), nullptr);
  EXPECT_EQ(feed.since(0), nullptr);
  const UpdateFeed::Update first = feed.publish(ground.view(0.5));
  EXPECT_EQ(first->sequence, 1u);
  EXPECT_EQ(first->changed, 70 * 66);
  EXPECT_EQ(feed.publish(ground.view(1)), first) << "nothing changed";
  std::vector<heightfield::SoilLayer> taken;
  ground.take_above(20, 30, -0.2, taken);
  const UpdateFeed::Update second = feed.publish(ground.view(1.5));
  EXPECT_EQ(second->sequence, 2u);
  EXPECT_EQ(second->since, 1u);
  EXPECT_EQ(second->time, 1.5);
  // The column, and the slopes next to it; that of the pit's own floor stays level.
  EXPECT_EQ(second->changed, 5);
  EXPECT_EQ(feed.since(1), second);
  EXPECT_EQ(feed.since(2), nullptr);
  // A number that was never issued counts as no number.
  EXPECT_EQ(feed.since(7)->since, 0u);
  EXPECT_EQ(feed.since(0)->rects.size(), 1u);
}

TEST(UpdateFeed, NumbersMapsByTheirUpdate) {
  Ground ground(testing::setup(70, 66));
  UpdateFeed feed(two_layers());
  Random random(8);
  int number = 0;
  for (std::uint64_t i = 1; i <= 5; ++i) {
    const UpdateFeed::Update update = feed.publish(ground.view(static_cast<double>(i)));
    EXPECT_EQ(update->sequence, i);
    EXPECT_EQ(update->map.sequence(), i);
    // Without a change, no number is used.
    EXPECT_EQ(feed.publish(ground.view(static_cast<double>(i)))->map.sequence(), i);
    EXPECT_EQ(feed.since(0)->map.sequence(), i);
    dig(ground, random, number);
  }
  // A request by a map's number returns the changes after that map.
  const std::uint64_t seen = feed.latest()->map.sequence();
  const UpdateFeed::Update next = feed.publish(ground.view(6));
  ASSERT_NE(feed.since(seen), nullptr);
  EXPECT_EQ(feed.since(seen)->changed, next->changed);
  EXPECT_GT(next->changed, 0);
}

TEST(UpdateFeed, RestartsItsCountWhenTimeGoesBackOrOnRequest) {
  Ground ground(testing::setup(70, 66));
  MapOptions options = two_layers();
  options.layers.push_back(MapLayer::kDisturbedAt);
  UpdateFeed feed(options);
  Random random(8);
  int number = 0;
  for (int i = 0; i < 4; ++i) {
    feed.publish(ground.view(i));
    dig(ground, random, number);
  }
  const auto disturbed = [&] {
    const std::vector<float> at = feed.latest()->map.copy(MapLayer::kDisturbedAt);
    return std::count_if(at.begin(), at.end(), [](float t) { return t == t; });
  };
  EXPECT_EQ(feed.publish(ground.view(4))->sequence, 5u);
  EXPECT_GT(disturbed(), 0);
  const auto expect_anew = [&](const UpdateFeed::Update& update, std::uint64_t sequence) {
    EXPECT_EQ(update->sequence, sequence) << "numbering continues";
    EXPECT_EQ(update->since, 0u);
    EXPECT_EQ(update->changed, 70 * 66);
    EXPECT_EQ(disturbed(), 0) << "the earlier history is unknown";
    for (const std::uint64_t seen : {std::uint64_t{0}, std::uint64_t{1}, sequence - 1})
      EXPECT_EQ(feed.since(seen)->since, 0u) << seen;
  };
  // The ground is the same, but its time is not.
  expect_anew(feed.publish(ground.view(1)), 6);
  feed.restart();
  expect_anew(feed.publish(ground.view(1)), 7);
  // Later updates count as before; a reader with an earlier map still starts over.
  dig(ground, random, number);
  const UpdateFeed::Update next = feed.publish(ground.view(2));
  EXPECT_EQ(next->since, 7u);
  EXPECT_LT(next->changed, 100);
  EXPECT_EQ(feed.since(7), next);
  EXPECT_EQ(feed.since(6)->since, 0u);
  EXPECT_GT(disturbed(), 0);
}

TEST(UpdateFeed, ReportsAtMostTwiceTheChangedAreaIf64RectanglesSuffice) {
  Ground ground(testing::setup(340, 260));
  UpdateFeed feed({});
  feed.publish(ground.view(0));
  const auto area = [](const MapUpdate& update) {
    std::int64_t sum = 0;
    for (const heightfield::CellRect& rect : update.rects) sum += rect.area();
    return sum;
  };
  Random random(6);
  int number = 0;
  for (int i = 1; i <= 60; ++i) {
    // As many pits as fit into the list, each of its own size at its own place of a grid.
    std::vector<heightfield::SoilLayer> taken;
    for (int pit = 0; pit < i; ++pit) {
      const int x0 = 10 + 40 * (pit % 8), y0 = 8 + 30 * (pit / 8);
      const int nx = static_cast<int>(random.uniform(1, 12)),
                ny = static_cast<int>(random.uniform(1, 12));
      for (int iy = y0; iy < y0 + ny; ++iy)
        for (int ix = x0; ix < x0 + nx; ++ix)
          ground.take_above(ix, iy, ground.height(ix, iy) - 0.01, taken);
    }
    const UpdateFeed::Update update = feed.publish(ground.view(i));
    ASSERT_LE(area(*update), 2 * update->changed) << i << " pits";
    EXPECT_FALSE(update->merged);
  }
  // More pits than fit: rectangles are united, and this is reported.
  for (int pit = 0; pit < 400; ++pit) dig(ground, random, number);
  const UpdateFeed::Update many = feed.publish(ground.view(61));
  EXPECT_LE(many->rects.size(), 64u);
  EXPECT_EQ(many->merged, area(*many) > 2 * many->changed);
}

/// Returns a map's elevation as one number.
std::uint64_t print_of(const TerrainMap& map) {
  const std::vector<float> z = map.copy(MapLayer::kElevation);
  StateHash hash;
  hash.bytes(z.data(), z.size() * sizeof(float));
  return hash.digest();
}

/// Applies every update to its own copy, until `ended` and no update is left.
struct Follower {
  std::vector<float> mine;
  int faults = 0, returns = 0;

  void follow(const UpdateFeed& feed, const std::atomic<bool>& ended, bool dies, int pause_us) {
    std::uint64_t seen = 0;
    Random random(dies ? 3 : 4);
    for (;;) {
      const bool last = ended;
      const UpdateFeed::Update update = feed.wait(seen, 0.02);
      if (update == nullptr && last) return;
      if (update == nullptr) continue;
      if (update->sequence <= seen || (update->since != seen && update->since != 0)) ++faults;
      if (update->rects.size() > 64) ++faults;
      apply(*update, mine, MapLayer::kElevation);
      seen = update->sequence;
      // Its copy equals the map of that number.
      if (mine != update->map.copy(MapLayer::kElevation)) ++faults;
      if (dies && random.uniform() < 0.02) {
        mine.clear();
        seen = 0;
        ++returns;
      }
      std::this_thread::sleep_for(std::chrono::microseconds(pause_us));
    }
  }
};

/// Repeats every kind of query on the newest map, and records the map's number and its content.
struct Asker {
  std::vector<std::pair<std::uint64_t, std::uint64_t>> held;  ///< sequence, print of the elevation
  int faults = 0;

  void ask(const UpdateFeed& feed, const std::atomic<bool>& ended, std::uint64_t seed) {
    Random random(seed);
    for (std::uint64_t seen = 0; !ended;) {
      const UpdateFeed::Update update = feed.latest();
      if (update->sequence < seen) ++faults;
      seen = update->sequence;
      const TerrainMap& map = update->map;
      // Twice: the answer for one map stays the same, whatever the feed publishes meanwhile.
      const double x = random.uniform(-3, 3.4), y = random.uniform(2, 8),
                   yaw = random.uniform(-3, 3);
      const auto answer = [&] {
        const bool sees = line_of_sight(map, Vec3(x, y, 0.3), Vec3(0, 5, 0.3)) == Sight::kFree;
        return height(map, x, y) + slope(map, x, y) +
               static_cast<double>(value(map, MapLayer::kTraversability, x, y)) +
               planner::clearance(map, {0.3, 0.3, 0.2, 0.2}, x, y, yaw, 0.5) + (sees ? 1 : 0) +
               cut_and_fill(map, std::vector{Vec2(-2, 3), Vec2(3, 4), Vec2(x, y)}).cut;
      };
      const double first = answer();
      held.emplace_back(seen, print_of(map));
      if (answer() != first || std::isnan(first)) ++faults;
      // Leaves time to the other threads where cores are few.
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
  }
};

TEST(UpdateFeed, TenThousandUpdatesReachSlowAndDyingReadersDuringQueries) {
  constexpr int kUpdates = 10000;
  Ground ground(testing::setup(70, 66));
  MapOptions options;
  options.layers = {MapLayer::kElevation, MapLayer::kElevationStart, MapLayer::kSlope,
                    MapLayer::kTraversability};
  UpdateFeed feed(options);
  std::atomic<bool> ended{false};
  // Fingerprints of the map of each number, written by the publishing thread only; index 0 is no
  // map.
  std::vector<std::uint64_t> prints(1);
  prints.push_back(print_of(feed.publish(ground.view(0))->map));
  Follower slow, dying;
  std::vector<Asker> askers(4);
  std::vector<std::thread> threads;
  threads.emplace_back([&] { slow.follow(feed, ended, false, 3000); });
  threads.emplace_back([&] { dying.follow(feed, ended, true, 100); });
  for (std::size_t i = 0; i < askers.size(); ++i)
    threads.emplace_back([&, i] { askers[i].ask(feed, ended, 20 + i); });
  Random random(9);
  int number = 0;
  for (int i = 1; i <= kUpdates; ++i) {
    dig(ground, random, number);
    prints.push_back(print_of(feed.publish(ground.view(0.01 * i))->map));
  }
  ended = true;
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(slow.faults, 0);
  EXPECT_EQ(dying.faults, 0);
  EXPECT_GT(dying.returns, 0);
  // A torn map would have heights of another number.
  std::set<std::uint64_t> asked;
  for (const Asker& asker : askers) {
    EXPECT_EQ(asker.faults, 0);
    for (const auto& [sequence, print] : asker.held) {
      ASSERT_EQ(print, prints.at(sequence)) << "map " << sequence;
      asked.insert(sequence);
    }
  }
  EXPECT_GT(asked.size(), 100u) << "the queries ran during updates";
  const TerrainMap last = feed.latest()->map;
  EXPECT_EQ(feed.latest()->sequence, kUpdates + 1u);
  EXPECT_EQ(slow.mine, last.copy(MapLayer::kElevation));
  EXPECT_EQ(dying.mine, last.copy(MapLayer::kElevation));
  MapMaker anew(options);
  anew.update(ground.view(100));
  EXPECT_TRUE(same(anew.map(), last));
  EXPECT_EQ(std::set<std::uint64_t>(prints.begin(), prints.end()).size(), prints.size())
      << "indistinguishable maps";
}

TEST(UpdateFeed, CallsSubscribersWithEveryUpdate) {
  Ground ground(testing::setup(20, 20));
  UpdateFeed feed(two_layers());
  std::vector<std::uint64_t> seen;
  feed.subscribe([&](const UpdateFeed::Update& update) { seen.push_back(update->sequence); });
  Random random(1);
  int number = 0;
  for (int i = 0; i < 5; ++i) {
    dig(ground, random, number);
    feed.publish(ground.view(i));
  }
  EXPECT_EQ(seen, (std::vector<std::uint64_t>{1, 2, 3, 4, 5}));
}

}  // namespace
}  // namespace navvy::map
