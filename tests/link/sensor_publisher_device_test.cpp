// SPDX-License-Identifier: Apache-2.0
#include "link/sensor_publisher.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "core/error.h"
#include "link/tcp_client.h"
#include "run/scene.h"
#include "run/simulation.h"
#include "sim/sampler.h"

namespace navvy::link {
namespace {

using nlohmann::json;
using testing::connected;
using testing::receive;

/// Returns the next line of the stream as JSON; discarded JSON if there is none.
json next_line(int file) {
  std::string line;
  for (std::string one = receive(file, 1); !one.empty() && one != "\n"; one = receive(file, 1))
    line += one;
  return json::parse(line, nullptr, false);
}

/// A reader that has connected and taken the first line.
class Reader {
 public:
  explicit Reader(const SensorPublisher& publisher) : file_(connected(publisher.port())) {
    first_ = next();
  }
  ~Reader() { ::close(file_); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
  const json& first() const { return first_; }
  json next() const { return next_line(file_); }
  std::string bytes(const json& head) const { return receive(file_, head.at("bytes")); }

 private:
  int file_;
  json first_;
};

/// The first line may arrive just before the server has counted what the reader will get.
void settle() { std::this_thread::sleep_for(std::chrono::milliseconds(100)); }

std::string bytes_of(const sim::ArrayView& view) {
  return {reinterpret_cast<const char*>(view.bytes().data()), view.bytes().size()};
}

TEST(SensorPublisher, SendsEachNewReadingWithItsStampsToAllReaders) {
  run::Simulation simulation(run::test::gauged_scene(2), run::test::with_height_grid());
  SensorPublisher publisher(simulation.world(), "tcp:0");
  const Reader one(publisher), other(publisher);
  settle();
  ASSERT_EQ(one.first().at("arrays").size(), simulation.arrays().channels().size());
  EXPECT_EQ(one.first().at("arrays")[0].at("name"), simulation.arrays().channels()[0].name);
  const int gauge = simulation.arrays().index("bucket/gauge/state");
  int readings = 0, lines = 0;
  for (int i = 0; i < 30; ++i) {
    std::vector<std::uint64_t> before;
    for (std::size_t a = 0; a < simulation.arrays().channels().size(); ++a)
      before.push_back(simulation.arrays().view(static_cast<int>(a)).sequence());
    simulation.step(1);
    publisher.publish();
    for (std::size_t a = 0; a < before.size(); ++a) {
      const sim::ArrayView view = simulation.arrays().view(static_cast<int>(a));
      if (view.sequence() == before[a]) continue;
      readings += static_cast<int>(a) == gauge;
      ++lines;
      for (const Reader* reader : {&one, &other}) {
        const json head = reader->next();
        ASSERT_TRUE(head.is_object());
        EXPECT_EQ(head.at("name"), view.channel().name);
        EXPECT_EQ(head.at("sequence"), view.sequence());
        EXPECT_EQ(head.at("time"), view.time());
        EXPECT_EQ(head.at("delivered"), view.delivered());
        EXPECT_EQ(head.at("type"), sim::name_of(view.channel().type));
        EXPECT_EQ(reader->bytes(head), bytes_of(view));
      }
    }
  }
  EXPECT_GE(readings, 2);
  EXPECT_GT(lines, readings);
  publisher.finish();
  EXPECT_EQ(one.next(), json({{"end", true}}));
  EXPECT_TRUE(one.next().is_discarded());
}

TEST(SensorPublisher, TellsThatTheStateWasReplaced) {
  run::Simulation simulation(run::test::gauged_scene(2));
  SensorPublisher publisher(simulation.world(), "tcp:0");
  const Reader reader(publisher);
  settle();
  simulation.step(10);
  simulation.reset();
  publisher.restart();
  publisher.publish();
  publisher.finish();
  EXPECT_EQ(reader.next(), json({{"restarted", 0.0}}));
  EXPECT_EQ(reader.next(), json({{"end", true}}));
}

/// A sensor of 4 MiB a step; each element is the number of the reading.
class LargeImage final : public sim::Sampler {
 public:
  static constexpr int kCount = 1 << 20;
  std::string name() const override { return "large"; }
  double rate() const override { return 0; }
  void declare(sim::Publisher& out) override {
    sim::ArrayChannel channel;
    channel.name = "large";
    channel.unit = "1";
    channel.meaning = "number of the reading";
    channel.frame = "world";
    channel.type = sim::ElementType::kInt32;
    channel.shape = {kCount};
    image_ = out.declare(channel);
  }
  void sample(const sim::World&, sim::Publisher& out) override {
    const std::span<std::int32_t> values = out.fill<std::int32_t>(image_, Pose::Identity());
    std::fill(values.begin(), values.end(), ++count_);
  }
  void visit(Archive& a) override { a("count", count_); }

 private:
  int image_ = -1;
  std::int32_t count_ = 0;
};

TEST(SensorPublisher, NeverWaitsForAReaderAndCountsWhatItMissed) {
  run::SimulationOptions options;
  options.set_up = [](session::Session& session) { session.add(std::make_unique<LargeImage>()); };
  run::Simulation simulation(run::test::bucket_scene(2), options);
  SensorPublisher publisher(simulation.world(), "tcp:0");
  const Reader slow(publisher);
  settle();
  const std::uint64_t before = simulation.arrays().view("large").sequence();
  // Twice what is kept, and more than the system takes for a reader that does not read.
  constexpr int kSteps = 2 * SensorPublisher::kMostBytes / (4 * LargeImage::kCount);
  for (int i = 0; i < kSteps; ++i) {
    simulation.step(1);
    publisher.publish();
  }
  std::thread finish([&] { publisher.finish(); });
  std::uint64_t sequence = before, missed = 0;
  for (json head = slow.next(); !head.contains("end"); head = slow.next()) {
    ASSERT_TRUE(head.is_object());
    if (head.contains("missed")) {
      missed += head.at("missed").get<std::uint64_t>();
      continue;
    }
    const std::string bytes = slow.bytes(head);
    ASSERT_EQ(bytes.size(), 4u * LargeImage::kCount);
    sequence = head.at("sequence");
    // A reading never changes after it was handed on.
    std::int32_t ends[2];
    std::memcpy(&ends[0], bytes.data(), 4);
    std::memcpy(&ends[1], bytes.data() + bytes.size() - 4, 4);
    EXPECT_EQ(static_cast<std::uint64_t>(ends[0]), sequence);
    EXPECT_EQ(static_cast<std::uint64_t>(ends[1]), sequence);
  }
  finish.join();
  EXPECT_EQ(sequence, before + kSteps) << "the newest one is never missed";
  EXPECT_GE(missed, 8u);
  EXPECT_LE(missed, kSteps - 15u);
}

TEST(SensorPublisher, RefusesPortsInUseAndInvalidAddresses) {
  run::Simulation simulation(run::test::gauged_scene(2));
  const SensorPublisher publisher(simulation.world(), "tcp:0");
  const auto message = [](const std::string& address) -> std::string {
    try {
      SensorPublisher::require_address(address);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  const std::string taken = message("tcp:" + std::to_string(publisher.port()));
  EXPECT_NE(taken.find("--publish-sensors"), std::string::npos) << taken;
  EXPECT_NE(taken.find("Address already in use"), std::string::npos) << taken;
  EXPECT_NE(message("readings").find("tcp:PORT"), std::string::npos) << message("readings");
  EXPECT_NE(message("tcp:70000").find("0 to 65535"), std::string::npos);
  EXPECT_EQ(message("tcp:0"), "");
}

}  // namespace
}  // namespace navvy::link
