// SPDX-License-Identifier: Apache-2.0
#include "planner/updates.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstring>
#include <thread>

#include "core/error.h"
#include "core/file.h"
#include "core/random.h"
#include "folder.h"
#include "heightfield/maps.h"
#include "paths.h"
#include "planner/grounds.h"
#include "planner/publisher.h"

namespace navvy::planner {
namespace {

using heightfield::Ground;

const std::vector<Layer> kTwo = {Layer::kElevation, Layer::kSlope};

MapOptions two_layers() {
  MapOptions out;
  out.layers = kTwo;
  return out;
}

/// Takes a small pit out, deeper every time it comes back.
void dig(Ground& ground, Random& random, int& number) {
  std::vector<heightfield::Layer> taken;
  const int x0 = static_cast<int>(random.uniform(0, ground.nx() - 4)),
            y0 = static_cast<int>(random.uniform(0, ground.ny() - 4));
  ++number;
  for (int iy = y0; iy < y0 + 4; ++iy)
    for (int ix = x0; ix < x0 + 4; ++ix) ground.take_above(ix, iy, ground.height(ix, iy) - 0.001, taken);
}

bool same(const TerrainMap& a, const TerrainMap& b) { return count_changed(a, b) == 0; }

/// Applies an update to a copy of what its reader has.
void apply(const MapUpdate& update, std::vector<float>& mine, Layer layer) {
  const TerrainMap& map = update.map;
  if (mine.empty()) mine.assign(static_cast<std::size_t>(map.rect().area()), kUnknown);
  for (const heightfield::CellRect& r : update.rects)
    for (int iy = r.y0; iy < r.y1; ++iy)
      for (int ix = r.x0; ix < r.x1; ++ix)
        mine[static_cast<std::size_t>(iy) * static_cast<std::size_t>(map.nx()) + static_cast<std::size_t>(ix)] =
            map.at(layer, ix, iy);
}

TEST(UpdateFeed, SendsALargeMapInPiecesThatAreItsPatch) {
  // Higher than a piece has rows.
  Ground ground(testing::setup(70, 600));
  UpdateFeed feed(two_layers());
  const UpdateFeed::Update first = feed.publish(ground.view());
  std::vector<char> sent;
  int pieces = 0;
  EXPECT_TRUE(send_patch(*first, kTwo, [&](const char* bytes, std::size_t count) {
    sent.insert(sent.end(), bytes, bytes + count);
    return ++pieces > 0;
  }));
  EXPECT_EQ(pieces, 7) << "the header, and of each layer 256, 256 and 88 rows";
  EXPECT_EQ(sent, patch_bytes(*first, kTwo));
  const std::vector<float> slope = first->map.copy(Layer::kSlope);
  ASSERT_GT(sent.size(), slope.size() * 2 * sizeof(float));
  EXPECT_EQ(
      std::memcmp(sent.data() + sent.size() - slope.size() * sizeof(float), slope.data(), slope.size() * sizeof(float)),
      0);
  int until = 3;
  EXPECT_FALSE(send_patch(*first, kTwo, [&](const char*, std::size_t) { return --until > 0; }));
  EXPECT_EQ(until, 0) << "ends when it is told to";
}

TEST(UpdateFeed, NumbersWhatChangedAndTellsNothingElse) {
  Ground ground(testing::setup(70, 66));
  UpdateFeed feed(two_layers());
  EXPECT_EQ(feed.latest(), nullptr);
  EXPECT_EQ(feed.since(0), nullptr);
  const UpdateFeed::Update first = feed.publish(ground.view(0.5));
  EXPECT_EQ(first->sequence, 1u);
  EXPECT_EQ(first->changed, 70 * 66);
  EXPECT_EQ(feed.publish(ground.view(1)), first) << "nothing changed";
  std::vector<heightfield::Layer> taken;
  ground.take_above(20, 30, -0.2, taken);
  const UpdateFeed::Update second = feed.publish(ground.view(1.5));
  EXPECT_EQ(second->sequence, 2u);
  EXPECT_EQ(second->since, 1u);
  EXPECT_EQ(second->time, 1.5);
  // The column, and the slopes beside it; that of the pit's own floor is level as before.
  EXPECT_EQ(second->changed, 5);
  EXPECT_EQ(feed.since(1), second);
  EXPECT_EQ(feed.since(2), nullptr);
  // Numbers that were never given out count from nothing.
  EXPECT_EQ(feed.since(7)->since, 0u);
  EXPECT_EQ(feed.since(0)->rects.size(), 1u);
}

TEST(UpdateFeed, TenThousandUpdatesReachASlowReaderAndOneThatDiesWholeAndInOrder) {
  Ground ground(testing::setup(70, 66));
  UpdateFeed feed(two_layers());
  std::atomic<bool> ended{false};
  std::atomic<int> faults{0}, patches{0}, returns{0};
  std::vector<float> slow, dying;
  // Torn would be a map whose elevation is of another update than its number: each update takes a known mass away.
  const auto read = [&](std::vector<float>& mine, bool dies, int pause_us) {
    std::uint64_t seen = 0;
    Random random(dies ? 3 : 4);
    for (;;) {
      const bool last = ended;
      const UpdateFeed::Update update = feed.wait(seen, 0.02);
      if (update == nullptr && last) return;
      if (update == nullptr) continue;
      if (update->sequence <= seen || (update->since != seen && update->since != 0)) ++faults;
      if (update->rects.size() > 64) ++faults;
      apply(*update, mine, Layer::kElevation);
      seen = update->sequence;
      ++patches;
      // What it has is the map of that number, whole.
      if (mine != update->map.copy(Layer::kElevation)) ++faults;
      if (dies && random.uniform() < 0.02) {
        mine.clear();
        seen = 0;
        ++returns;
      }
      std::this_thread::sleep_for(std::chrono::microseconds(pause_us));
    }
  };
  feed.publish(ground.view(0));
  std::thread one(read, std::ref(slow), false, 3000), two(read, std::ref(dying), true, 100);
  Random random(9);
  int number = 0;
  for (int i = 1; i <= 10000; ++i) {
    dig(ground, random, number);
    feed.publish(ground.view(0.01 * i));
  }
  ended = true;
  one.join();
  two.join();
  EXPECT_EQ(faults, 0);
  EXPECT_GT(returns, 0);
  const TerrainMap last = feed.latest()->map;
  EXPECT_EQ(feed.latest()->sequence, 10001u);
  EXPECT_EQ(slow, last.copy(Layer::kElevation));
  EXPECT_EQ(dying, last.copy(Layer::kElevation));
  MapMaker anew(two_layers());
  anew.update(ground.view(100));
  EXPECT_TRUE(same(anew.map(), last));
}

TEST(UpdateFeed, CallsWhoSubscribedWithEveryUpdate) {
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

bool has_numpy() { return std::system("/usr/bin/python3 -c 'import numpy' >/dev/null 2>&1") == 0; }

// Follows with the example's reader and writes the elevation that it ends with.
const char* const kFollow = R"(
import sys
sys.path.insert(0, sys.argv[1])
from read_patches import follow
count = 0
for header, layers in follow(sys.argv[2]): count += 1
layers['elevation'].astype('<f4').tofile(sys.argv[3])
print(header['sequence'], count)
)";

void expect_same_as_python(const std::string& place, const test::Folder& folder, const std::function<void()>& publish,
                           const UpdateFeed& feed) {
  heightfield::testing::write_text(folder / "follow.py", kFollow);
  const std::string command = "/usr/bin/python3 '" + folder / "follow.py" + "' '" + navvy::source_dir() +
                              "/examples/planner' " + place + " '" + folder / "end.bin" + "'";
  std::string said;
  if (place[0] == '/') publish();
  std::thread python([&] { said = heightfield::testing::output_of(command); });
  if (place[0] != '/') publish();
  python.join();
  const TerrainMap last = feed.latest()->map;
  const std::vector<char> end = read_file(folder / "end.bin");
  const std::vector<float> mine = last.copy(Layer::kElevation);
  ASSERT_EQ(end.size(), mine.size() * sizeof(float)) << said;
  EXPECT_EQ(std::memcmp(end.data(), mine.data(), end.size()), 0);
  EXPECT_EQ(std::stoull(said), feed.latest()->sequence);
}

TEST(Publisher, OverTcpGivesTheExamplesReaderTheSameMap) {
  if (!has_numpy()) GTEST_SKIP() << "NumPy is missing";
  const test::Folder folder;
  Ground ground(testing::setup(70, 66));
  UpdateFeed feed(two_layers());
  auto publisher = std::make_unique<Publisher>(feed, "tcp:0", kTwo);
  expect_same_as_python(
      std::to_string(publisher->port()), folder,
      [&] {
        Random random(2);
        int number = 0;
        // Slow enough for a reader that begins while it goes on; the end closes its stream.
        for (int i = 0; i < 300; ++i) {
          dig(ground, random, number);
          feed.publish(ground.view(i));
          std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        publisher.reset();
      },
      feed);
}

TEST(Publisher, IntoAFolderGivesTheExamplesReaderTheSameMap) {
  if (!has_numpy()) GTEST_SKIP() << "NumPy is missing";
  const test::Folder folder;
  Ground ground(testing::setup(70, 66));
  UpdateFeed feed(two_layers());
  auto publisher = std::make_unique<Publisher>(feed, folder / "maps", kTwo);
  expect_same_as_python(
      folder / "maps", folder,
      [&] {
        Random random(2);
        int number = 0;
        for (int i = 0; i < 40; ++i) {
          dig(ground, random, number);
          feed.publish(ground.view(i));
        }
        publisher.reset();
      },
      feed);
}

TEST(Publisher, RefusesAPortThatIsTakenAndPlacesThatAreNone) {
  const test::Folder folder;
  UpdateFeed feed(two_layers()), other(two_layers());
  const Publisher publisher(feed, "tcp:0", kTwo);
  const auto message = [&](const std::string& place) {
    try {
      const Publisher second(other, place, kTwo);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string taken = message("tcp:" + std::to_string(publisher.port()));
  EXPECT_NE(taken.find("Address already in use"), std::string::npos) << taken;
  EXPECT_NE(taken.find("another port"), std::string::npos) << taken;
  EXPECT_NE(message("tcp:70000").find("0 to 65535"), std::string::npos);
  EXPECT_NE(message("tcp:").find("no port"), std::string::npos);
  EXPECT_NE(message("tcp:here:5").find("IPv4"), std::string::npos);
  heightfield::testing::write_text(folder / "mine.txt", "x");
  EXPECT_NE(message(folder / "").find("mine.txt"), std::string::npos);
}

}  // namespace
}  // namespace navvy::planner
