// SPDX-License-Identifier: Apache-2.0
#include "planner/updates.h"

#include <gtest/gtest.h>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <cstring>
#include <set>
#include <thread>
#include <utility>

#include "core/error.h"
#include "core/file.h"
#include "core/hash.h"
#include "core/random.h"
#include "folder.h"
#include "heightfield/maps.h"
#include "paths.h"
#include "planner/footprint.h"
#include "planner/grounds.h"
#include "planner/publisher.h"
#include "planner/queries.h"
#include "planner/volume.h"

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

TEST(UpdateFeed, TellsRectanglesOfAtMostTwiceWhatChangedWhere64Suffice) {
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
    // As many pits as fit into the list, each of its own size and at its own place of a grid.
    std::vector<heightfield::Layer> taken;
    for (int pit = 0; pit < i; ++pit) {
      const int x0 = 10 + 40 * (pit % 8), y0 = 8 + 30 * (pit / 8);
      const int nx = static_cast<int>(random.uniform(1, 12)), ny = static_cast<int>(random.uniform(1, 12));
      for (int iy = y0; iy < y0 + ny; ++iy)
        for (int ix = x0; ix < x0 + nx; ++ix) ground.take_above(ix, iy, ground.height(ix, iy) - 0.01, taken);
    }
    const UpdateFeed::Update update = feed.publish(ground.view(i));
    ASSERT_LE(area(*update), 2 * update->changed) << i << " pits";
    EXPECT_FALSE(update->merged);
  }
  // More than fit: united, and told.
  for (int pit = 0; pit < 400; ++pit) dig(ground, random, number);
  const UpdateFeed::Update many = feed.publish(ground.view(61));
  EXPECT_LE(many->rects.size(), 64u);
  EXPECT_EQ(many->merged, area(*many) > 2 * many->changed);
}

/// A map's elevation as one number.
std::uint64_t print_of(const TerrainMap& map) {
  const std::vector<float> z = map.copy(Layer::kElevation);
  StateHash hash;
  hash.bytes(z.data(), z.size() * sizeof(float));
  return hash.digest();
}

/// Applies every update it gets to a copy of its own, until `ended` and nothing is left.
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
      apply(*update, mine, Layer::kElevation);
      seen = update->sequence;
      // What it has is the map of that number, whole.
      if (mine != update->map.copy(Layer::kElevation)) ++faults;
      if (dies && random.uniform() < 0.02) {
        mine.clear();
        seen = 0;
        ++returns;
      }
      std::this_thread::sleep_for(std::chrono::microseconds(pause_us));
    }
  }
};

/// Asks the newest map every kind of question, again and again, and notes which map it was and what it holds.
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
      // Twice: what is answered for one map stays so, however far the feed has come meanwhile.
      const double x = random.uniform(-3, 3.4), y = random.uniform(2, 8), yaw = random.uniform(-3, 3);
      const auto answer = [&] {
        const bool sees = line_of_sight(map, Vec3(x, y, 0.3), Vec3(0, 5, 0.3)) == Sight::kFree;
        return height(map, x, y) + slope(map, x, y) + static_cast<double>(value(map, Layer::kTraversability, x, y)) +
               clearance(map, {0.3, 0.3, 0.2, 0.2}, x, y, yaw, 0.5) + (sees ? 1 : 0) +
               cut_and_fill(map, std::vector{Vec2(-2, 3), Vec2(3, 4), Vec2(x, y)}).cut;
      };
      const double first = answer();
      held.emplace_back(seen, print_of(map));
      if (answer() != first || std::isnan(first)) ++faults;
      // Room for the others, where cores are few.
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
  }
};

TEST(UpdateFeed, TenThousandUpdatesReachASlowReaderAndOneThatDiesWhileFourThreadsAsk) {
  constexpr int kUpdates = 10000;
  Ground ground(testing::setup(70, 66));
  MapOptions options;
  options.layers = {Layer::kElevation, Layer::kElevationStart, Layer::kSlope, Layer::kTraversability};
  UpdateFeed feed(options);
  std::atomic<bool> ended{false};
  // Of the map of each number, by the one thread that publishes; index 0 is no map.
  std::vector<std::uint64_t> prints(1);
  prints.push_back(print_of(feed.publish(ground.view(0))->map));
  Follower slow, dying;
  std::vector<Asker> askers(4);
  std::vector<std::thread> threads;
  threads.emplace_back([&] { slow.follow(feed, ended, false, 3000); });
  threads.emplace_back([&] { dying.follow(feed, ended, true, 100); });
  for (std::size_t i = 0; i < askers.size(); ++i) threads.emplace_back([&, i] { askers[i].ask(feed, ended, 20 + i); });
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
  // Torn would be a map whose heights are another number's.
  std::set<std::uint64_t> asked;
  for (const Asker& asker : askers) {
    EXPECT_EQ(asker.faults, 0);
    for (const auto& [sequence, print] : asker.held) {
      ASSERT_EQ(print, prints.at(sequence)) << "map " << sequence;
      asked.insert(sequence);
    }
  }
  EXPECT_GT(asked.size(), 100u) << "they asked while it updated";
  const TerrainMap last = feed.latest()->map;
  EXPECT_EQ(feed.latest()->sequence, kUpdates + 1u);
  EXPECT_EQ(slow.mine, last.copy(Layer::kElevation));
  EXPECT_EQ(dying.mine, last.copy(Layer::kElevation));
  MapMaker anew(options);
  anew.update(ground.view(100));
  EXPECT_TRUE(same(anew.map(), last));
  EXPECT_EQ(std::set<std::uint64_t>(prints.begin(), prints.end()).size(), prints.size()) << "maps that look alike";
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

/// A connection to a publisher that reads so many bytes and goes away.
void read_and_leave(int port, std::size_t bytes) {
  const int file = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  ASSERT_EQ(::connect(file, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  std::vector<char> buffer(bytes);
  for (std::size_t at = 0; at < bytes;) {
    const ssize_t got = ::recv(file, buffer.data() + at, bytes - at, 0);
    ASSERT_GT(got, 0);
    at += static_cast<std::size_t>(got);
  }
  ::close(file);
}

TEST(Publisher, LosesNothingWhenReadersGoAwayInMidPatch) {
  if (!has_numpy()) GTEST_SKIP() << "NumPy is missing";
  const test::Folder folder;
  // 4 MB a whole map: more than the kernel keeps for a reader that does not read.
  Ground ground(testing::setup(700, 700));
  UpdateFeed feed(two_layers());
  auto publisher = std::make_unique<Publisher>(feed, "tcp:0", kTwo);
  feed.publish(ground.view(0));
  for (const std::size_t bytes : {0, 5, 300, 100000}) read_and_leave(publisher->port(), bytes);
  expect_same_as_python(
      std::to_string(publisher->port()), folder,
      [&] {
        Random random(2);
        int number = 0;
        for (int i = 1; i < 60; ++i) {
          dig(ground, random, number);
          feed.publish(ground.view(i));
          if (i % 10 == 0) read_and_leave(publisher->port(), 1000);
          std::this_thread::sleep_for(std::chrono::milliseconds(20));
        }
        EXPECT_EQ(publisher->fault(), "");
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
