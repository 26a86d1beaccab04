// SPDX-License-Identifier: Apache-2.0
#include "link/map_publisher.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <functional>
#include <iterator>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "core/error.h"
#include "core/file.h"
#include "core/random.h"
#include "folder.h"
#include "formats/map_patch.h"
#include "heightfield/maps.h"
#include "link/tcp_client.h"
#include "link/tcp_server.h"
#include "log_lines.h"
#include "map/feeds.h"
#include "map/grounds.h"
#include "paths.h"

namespace navvy::link {
namespace {

using heightfield::Ground;
using map::testing::dig;
using map::testing::kTwo;
using map::testing::two_layers;
using testing::connected;
using testing::receive;

bool has_numpy() { return std::system("/usr/bin/python3 -c 'import numpy' >/dev/null 2>&1") == 0; }

// Follows with the example's reader and writes its final elevation.
const char* const kFollow = R"(
import sys
sys.path.insert(0, sys.argv[1])
from read_patches import follow
count = 0
for header, layers in follow(sys.argv[2]): count += 1
layers['elevation'].astype('<f4').tofile(sys.argv[3])
print(header['sequence'], count)
)";

void expect_same_as_python(const std::string& place, const test::Folder& folder,
                           const std::function<void()>& publish, const map::UpdateFeed& feed) {
  heightfield::testing::write_text(folder / "follow.py", kFollow);
  const std::string command = "/usr/bin/python3 '" + folder / "follow.py" + "' '" +
                              navvy::source_dir() + "/examples/planner' " + place + " '" +
                              folder / "end.bin" + "'";
  std::string said;
  if (place[0] == '/') publish();
  std::thread python([&] { said = heightfield::testing::output_of(command); });
  if (place[0] != '/') publish();
  python.join();
  const map::TerrainMap last = feed.latest()->map;
  const std::vector<char> end = read_file(folder / "end.bin");
  const std::vector<float> mine = last.copy(map::MapLayer::kElevation);
  ASSERT_EQ(end.size(), mine.size() * sizeof(float)) << said;
  EXPECT_EQ(std::memcmp(end.data(), mine.data(), end.size()), 0);
  EXPECT_EQ(std::stoull(said), feed.latest()->sequence);
}

TEST(MapPublisher, ServesTheExampleReaderOverTcp) {
  if (!has_numpy()) GTEST_SKIP() << "NumPy is missing";
  const test::Folder folder;
  Ground ground(map::testing::setup(70, 66));
  map::UpdateFeed feed(two_layers());
  auto publisher = std::make_unique<MapPublisher>(feed, "tcp:0", kTwo);
  expect_same_as_python(
      std::to_string(publisher->port()), folder,
      [&] {
        Random random(2);
        int number = 0;
        // Slow enough for a reader that connects during the run; the end closes its stream.
        for (int i = 0; i < 300; ++i) {
          dig(ground, random, number);
          feed.publish(ground.view(i));
          std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        publisher.reset();
      },
      feed);
}

/// Reads this many bytes and disconnects.
void read_and_leave(int port, std::size_t bytes) {
  const int file = connected(port);
  EXPECT_EQ(receive(file, bytes).size(), bytes);
  ::close(file);
}

std::ptrdiff_t threads() {
  return std::distance(std::filesystem::directory_iterator("/proc/self/task"),
                       std::filesystem::directory_iterator());
}

/// Returns true if the condition becomes true within 10 s.
bool comes_true(const std::function<bool()>& what) {
  for (int i = 0; i < 200 && !what(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  return what();
}

TEST(MapPublisher, RemovesDisconnectedReadersWhileNothingIsPublished) {
  LogLines logged;
  Ground ground(map::testing::setup(20, 20));
  map::UpdateFeed feed(two_layers());
  feed.publish(ground.view(0));
  std::size_t whole = 0;
  formats::send_patch(*feed.since(0), kTwo, [&](const char*, std::size_t count) {
    whole += count;
    return true;
  });
  MapPublisher publisher(feed, "tcp:0", kTwo);
  const std::ptrdiff_t alone = threads();
  // Each reader takes its whole map and disconnects; nothing changes meanwhile.
  for (std::size_t i = 0; i < TcpServer::kMostReaders; ++i) read_and_leave(publisher.port(), whole);
  EXPECT_TRUE(comes_true([&] { return threads() == alone; }))
      << threads() << " threads, " << alone << " before";
  // As many new readers can connect.
  std::vector<int> readers;
  for (std::size_t i = 0; i < TcpServer::kMostReaders; ++i) {
    readers.push_back(connected(publisher.port()));
    ASSERT_EQ(receive(readers.back(), whole).size(), whole) << i;
  }
  EXPECT_TRUE(logged.lines().empty()) << logged.lines()[0];
  // One more is refused, with one log message.
  for (int i = 0; i < 2; ++i) {
    const int late = connected(publisher.port());
    EXPECT_EQ(receive(late, 1), "");
    ::close(late);
  }
  ASSERT_EQ(logged.lines().size(), 1u);
  EXPECT_NE(logged.lines()[0].find("64 are connected"), std::string::npos) << logged.lines()[0];
  for (const int file : readers) ::close(file);
  EXPECT_TRUE(comes_true([&] { return threads() == alone; }));
  read_and_leave(publisher.port(), whole);
}

TEST(MapPublisher, WaitsIfNoFileCanBeOpened) {
  LogLines logged;
  Ground ground(map::testing::setup(20, 20));
  map::UpdateFeed feed(two_layers());
  feed.publish(ground.view(0));
  MapPublisher publisher(feed, "tcp:0", kTwo);
  // A first reader connects and disconnects, so that the accepting thread and code that runs once
  // have run. Without free files, the sanitizers cannot inspect a new type: they use a pipe to test
  // whether its memory is readable.
  const std::ptrdiff_t alone = threads();
  read_and_leave(publisher.port(), 12);
  ASSERT_TRUE(comes_true([&] { return threads() == alone; }));
  rlimit before;
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &before), 0);
  const int file = ::socket(AF_INET, SOCK_STREAM, 0);
  // The next number is one too many.
  const rlimit full{static_cast<rlim_t>(file) + 1, before.rlim_max};
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(publisher.port()));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &full), 0);
  const int joined = ::connect(file, reinterpret_cast<const sockaddr*>(&address), sizeof address);
  const std::clock_t begun = std::clock();
  std::this_thread::sleep_for(std::chrono::seconds(1));
  const double spent = static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC;
  ::setrlimit(RLIMIT_NOFILE, &before);
  EXPECT_EQ(joined, 0);
  // A busy loop would use the whole second, less the time of other programs.
  EXPECT_LT(spent, 0.1) << "s of processor";
  ASSERT_EQ(logged.lines().size(), 1u);
  EXPECT_NE(logged.lines()[0].find("Too many open files"), std::string::npos) << logged.lines()[0];
  // It waited in the queue and receives its map.
  EXPECT_EQ(receive(file, 12).size(), 12u);
  ::close(file);
}

TEST(MapPublisher, LosesNothingWhenReadersDisconnectDuringAPatch) {
  if (!has_numpy()) GTEST_SKIP() << "NumPy is missing";
  const test::Folder folder;
  // 4 MB per whole map: more than the kernel buffers for a reader that does not read.
  Ground ground(map::testing::setup(700, 700));
  map::UpdateFeed feed(two_layers());
  auto publisher = std::make_unique<MapPublisher>(feed, "tcp:0", kTwo);
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

TEST(MapPublisher, ServesTheExampleReaderThroughAFolder) {
  if (!has_numpy()) GTEST_SKIP() << "NumPy is missing";
  const test::Folder folder;
  Ground ground(map::testing::setup(70, 66));
  map::UpdateFeed feed(two_layers());
  auto publisher = std::make_unique<MapPublisher>(feed, folder / "maps", kTwo);
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

TEST(MapPublisher, CanBeFollowedWhileItWritesAFolder) {
  if (!has_numpy()) GTEST_SKIP() << "NumPy is missing";
  const test::Folder folder;
  heightfield::testing::write_text(folder / "follow.py", kFollow);
  std::string said;
  Ground ground(map::testing::setup(70, 66));
  map::UpdateFeed feed(two_layers());
  // The reader starts first.
  std::thread python([&] {
    said = heightfield::testing::output_of("/usr/bin/python3 '" + folder / "follow.py" + "' '" +
                                           navvy::source_dir() + "/examples/planner' '" +
                                           folder / "maps" + "' '" + folder / "end.bin" + "'");
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  MapPublisher publisher(feed, folder / "maps", kTwo);
  Random random(2);
  int number = 0;
  for (int i = 0; i < 5; ++i) {
    dig(ground, random, number);
    feed.publish(ground.view(i));
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    EXPECT_FALSE(std::filesystem::exists(folder / "maps/end"));
  }
  publisher.finish();
  python.join();
  EXPECT_EQ(publisher.fault(), "");
  EXPECT_TRUE(std::filesystem::exists(folder / "maps/end"));
  EXPECT_EQ(said, "5 5\n") << "the last number, and the number of patches";
}

TEST(MapPublisher, ReportsAtItsEndThatTheLastPatchCouldNotBeWritten) {
  const test::Folder folder;
  Ground ground(map::testing::setup(20, 20));
  map::UpdateFeed feed(two_layers());
  MapPublisher publisher(feed, folder / "maps", kTwo);
  feed.publish(ground.view(0));
  ASSERT_TRUE(comes_true(
      [&] { return std::filesystem::exists(folder / "maps/patch_000000001.navvymap"); }));
  std::filesystem::remove_all(folder / "maps");
  Random random(2);
  int number = 0;
  dig(ground, random, number);
  feed.publish(ground.view(1));
  publisher.finish();
  EXPECT_NE(publisher.fault().find("patch_000000002.navvymap"), std::string::npos)
      << publisher.fault();
}

TEST(MapPublisher, RefusesPortsInUseAndInvalidPlaces) {
  const test::Folder folder;
  map::UpdateFeed feed(two_layers()), other(two_layers());
  const MapPublisher publisher(feed, "tcp:0", kTwo);
  const auto message = [&](const std::string& place) {
    try {
      const MapPublisher second(other, place, kTwo);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string taken = message("tcp:" + std::to_string(publisher.port()));
  EXPECT_NE(taken.find("Address already in use"), std::string::npos) << taken;
  EXPECT_NE(taken.find("another port"), std::string::npos) << taken;
  EXPECT_NE(message("tcp:70000").find("0 to 65535"), std::string::npos);
  EXPECT_NE(message("tcp:").find("is not a port from 0 to 65535"), std::string::npos);
  EXPECT_NE(message("tcp:here:5").find("IPv4"), std::string::npos);
  heightfield::testing::write_text(folder / "mine.txt", "x");
  EXPECT_NE(message(folder / "").find("mine.txt"), std::string::npos);
}

}  // namespace
}  // namespace navvy::link
