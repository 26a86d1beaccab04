// SPDX-License-Identifier: Apache-2.0
// Every kind of sensor goes on from a snapshot as if there had been none, and changes nothing in
// the world.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "core/saved_state.h"
#include "sensor/all_kinds.h"
#include "session/session.h"

namespace navvy::sensor {
namespace {

using testing::all_kinds;

std::unique_ptr<session::Session> started(device::Device& device, bool with_sensors = true) {
  auto out = std::make_unique<session::Session>(all_kinds(), device);
  if (!with_sensors) return out;
  for (auto& one : make_sensors(out->world())) out->add(std::move(one));
  return out;
}

void run_to(session::Session& session, double time) {
  while (session.world().time() < time - 1e-9) session.step();
}

TEST(ResumedSensors, OfEveryKindGiveTheReadingsOfTheWholeRun) {
  device::Device device;
  const auto whole = started(device);
  const sim::World& world = whole->world();
  ASSERT_EQ(testing::kinds_in(world.description()), std::variant_size_v<scene::SensorKind>)
      << "a kind has no sensor here";

  // In the middle of a sweep, while readings are on their way, with soil in the bucket.
  run_to(*whole, 2.02);
  const std::vector<char> state = saved(*whole);
  const auto resumed = started(device);
  load_saved(state, *resumed);
  std::vector<std::uint64_t> before;
  const std::size_t count = world.arrays().channels().size();
  for (std::size_t i = 0; i < count; ++i)
    before.push_back(world.arrays().view(static_cast<int>(i)).sequence());
  run_to(*whole, 2.2);
  run_to(*resumed, 2.2);
  for (std::size_t i = 0; i < count; ++i) {
    const sim::ArrayView one = world.arrays().view(static_cast<int>(i)),
                         other = resumed->world().arrays().view(static_cast<int>(i));
    const std::string& name = one.channel().name;
    EXPECT_GT(one.sequence(), before[i]) << name << " has no reading after the snapshot";
    EXPECT_EQ(one.sequence(), other.sequence()) << name;
    EXPECT_EQ(one.time(), other.time()) << name;
    EXPECT_TRUE(std::equal(one.bytes().begin(), one.bytes().end(), other.bytes().begin(),
                           other.bytes().end()))
        << name;
  }
}

TEST(AllSensors, ChangeNothingInTheStateHashWhileABucketDigs) {
  device::Device device;
  const auto with = started(device), without = started(device, false);
  ASSERT_EQ(testing::kinds_in(with->world().description()), std::variant_size_v<scene::SensorKind>)
      << "a kind has no sensor here";
  ASSERT_TRUE(without->world().arrays().channels().empty());
  // Before the cut, in it, and when the bucket is full.
  for (const double time : {0.5, 1.5, 2.5, 3.5}) {
    run_to(*with, time);
    run_to(*without, time);
    EXPECT_EQ(with->world().hashes().state(), without->world().hashes().state()) << time;
  }
  // The soil has moved, and all sensors have read it at 17 readings per second.
  EXPECT_GT(with->world().machines().at("bucket").tool("bucket").payload(), 100);
  for (std::size_t i = 0; i < with->world().arrays().channels().size(); ++i) {
    const sim::ArrayView view = with->world().arrays().view(static_cast<int>(i));
    EXPECT_GE(view.sequence(), 10u) << view.channel().name;
  }
}

}  // namespace
}  // namespace navvy::sensor
