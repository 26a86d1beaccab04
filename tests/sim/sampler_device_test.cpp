// SPDX-License-Identifier: Apache-2.0
#include "sim/sampler.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "core/error.h"
#include "core/saved_state.h"
#include "device/device.h"
#include "sim/height_grid.h"
#include "sim/scenes.h"
#include "sim/world_channels.h"

namespace navvy::sim {
namespace {

using testing::HeightGrid;

constexpr int kNodes = 9;
constexpr double kSpacing = 0.5, kRate = 50;

class SamplerTest : public ::testing::Test {
 protected:
  /// The trench's excavator, rolling over its site.
  std::unique_ptr<World> rolling(bool with_grid = true) {
    auto world = std::make_unique<World>(testing::load("trench.sdf"), device_);
    if (with_grid) world->add(grid(*world));
    world->commands().set(world->machines().at(0), {1.0, 0, false});
    return world;
  }
  static std::unique_ptr<Sampler> grid(const World& world) {
    return std::make_unique<HeightGrid>(world.machines().at(0), kNodes, kSpacing, kRate);
  }
  static void run_to(World& world, double time) {
    while (world.time() < time) world.step();
  }
  device::Device device_;
};

TEST_F(SamplerTest, SamplesAtOnceAndThenAtItsRate) {
  const auto world = rolling();
  const int grid = world->arrays().index("excavator/height_grid");
  EXPECT_EQ(world->arrays().view(grid).sequence(), 1u);
  EXPECT_EQ(world->arrays().view(grid).time(), 0);
  run_to(*world, 0.21);
  const ArrayView view = world->arrays().view(grid);
  EXPECT_EQ(view.sequence(), 1u + 10u);  // at 0 and after each of ten periods of 20 ms
  // Sampled in the step nearest to the period's end.
  EXPECT_LE(std::abs(view.time() - 0.2), 0.5 * world->dt() + 1e-9);
}

TEST_F(SamplerTest, PublishesTheGroundUnderTheMachineInItsFrame) {
  const auto world = rolling();
  run_to(*world, 0.1);
  const ArrayView view = world->arrays().view("excavator/height_grid");
  EXPECT_EQ(view.channel().unit, "m");
  EXPECT_EQ(view.channel().rate, kRate);
  EXPECT_EQ(view.channel().type_text(), "float32[9,9]");
  const std::span<const float> values = view.values<float>();
  ASSERT_EQ(values.size(), static_cast<std::size_t>(kNodes * kNodes));
  EXPECT_GT(view.X_WF().translation().x(), -9);  // it rolls
  for (const int row : {0, 4, 8}) {
    const Vec3 p_W = view.X_WF() * Vec3(kSpacing * (2 - 4), kSpacing * (row - 4), 0);
    // Meanwhile wheels press ruts: their depth in a tenth of a second.
    EXPECT_NEAR(values[static_cast<std::size_t>(row * kNodes + 2)],
                world->ground().sample(p_W.x(), p_W.y()) - view.X_WF().translation().z(), 0.02);
  }
  EXPECT_EQ(world->outputs().get("excavator/height_grid/samples"),
            static_cast<double>(view.sequence()));
  EXPECT_LE(world->outputs().get("excavator/height_grid/lowest"),
            static_cast<double>(values[0]) + 1e-6);
}

TEST_F(SamplerTest, IsReadInPlace) {
  const auto world = rolling();
  const std::byte* storage = world->arrays().view("excavator/height_grid").bytes().data();
  const std::uint64_t first = world->arrays().view(0).sequence();
  run_to(*world, 0.05);
  EXPECT_EQ(world->arrays().view(0).bytes().data(), storage);
  EXPECT_GT(world->arrays().view(0).sequence(), first);
}

TEST_F(SamplerTest, DoesNotAffectTheWorld) {
  const auto watched = rolling(), alone = rolling(false);
  run_to(*watched, 0.1);
  run_to(*alone, 0.1);
  const auto with = watched->hashes().parts(), without = alone->hashes().parts();
  ASSERT_GT(with.size(), without.size());
  for (std::size_t i = 0; i < without.size(); ++i) EXPECT_EQ(with[i], without[i]);
}

TEST_F(SamplerTest, ResumesFromASnapshotToTheSameState) {
  const auto whole = rolling();
  run_to(*whole, 0.05);
  const std::vector<char> bytes = saved(*whole);
  run_to(*whole, 0.1);
  const auto resumed = rolling();
  load_saved(bytes, *resumed);
  EXPECT_GT(resumed->arrays().view(0).sequence(), 1u);
  run_to(*resumed, 0.1);
  EXPECT_EQ(resumed->hashes().state(), whole->hashes().state());
  EXPECT_EQ(resumed->outputs().get("excavator/height_grid/samples"),
            whole->outputs().get("excavator/height_grid/samples"));
  const auto blind = rolling(false);
  EXPECT_THROW(load_saved(bytes, *blind), InputError);
}

TEST_F(SamplerTest, HasUniqueNamesAndSuggestsTheNearest) {
  const auto world = rolling();
  EXPECT_THROW(world->add(grid(*world)), InputError);
  try {
    world->arrays().view("excavator/hight_grid");
    FAIL() << "an unknown array was accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("excavator/height_grid"), std::string::npos)
        << error.what();
  }
  EXPECT_THROW(world->arrays().view(0).values<double>(), InputError);
  EXPECT_THROW(world->arrays().view(7), InputError);
}

/// Declares a new number, then a name that is taken.
class Clumsy final : public Sampler {
 public:
  std::string name() const override { return "clumsy"; }
  double rate() const override { return 1; }
  void declare(Publisher& out) override {
    out.declare(Channel{"clumsy/number", "1", ""});
    out.declare(Channel{"time", "s", ""});
  }
  void sample(const World&, Publisher&) override {}
};

TEST_F(SamplerTest, HasNoEffectWhenRefused) {
  const auto world = rolling(false);
  const std::string hash = world->hashes().state(), list = channel_list(*world);
  EXPECT_THROW(world->add(std::make_unique<Clumsy>()), InputError);
  EXPECT_EQ(channel_list(*world), list);
  EXPECT_EQ(world->hashes().state(), hash);
}

TEST_F(SamplerTest, IsInTheListOfChannels) {
  const auto world = rolling();
  const std::string list = channel_list(*world);
  EXPECT_NE(list.find("arrays:"), std::string::npos);
  EXPECT_NE(list.find("excavator/height_grid "), std::string::npos) << list;
  EXPECT_NE(list.find("float32[9,9] in excavator/height_grid, 50 Hz"), std::string::npos) << list;
  EXPECT_NE(list.find("excavator/height_grid/lowest"), std::string::npos) << list;
  EXPECT_EQ(channel_list(*rolling(false)).find("arrays:"), std::string::npos);
}

}  // namespace
}  // namespace navvy::sim
