// SPDX-License-Identifier: Apache-2.0
#include "sim/handles.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "core/error.h"
#include "core/saved_state.h"
#include "device/device.h"
#include "sim/scenes.h"
#include "sim/world.h"
#include "sim/world_parts.h"

namespace {
std::atomic<std::uint64_t> allocations{0};
}  // namespace

// Counts every allocation of this program: handles must not allocate.
void* operator new(std::size_t size) {
  ++allocations;
  if (void* p = std::malloc(size > 0 ? size : 1)) return p;
  throw std::bad_alloc();
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }

namespace navvy::sim {
namespace {

class Handles : public ::testing::Test {
 protected:
  device::Device device_;
};

template <class Call>
std::string failure(Call&& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST_F(Handles, DescribeTheirChannels) {
  World world(testing::load("trench.sdf"), device_);
  const MachineHandle machine = world.machines().at("excavator");
  const JointHandle boom = machine.joint("boom_joint");
  const WheelHandle wheel = machine.wheel(0);
  const ToolHandle bucket = machine.tool("bucket");
  world.commands().set(boom, {vehicle::JointMode::kVelocity, 0.1});
  world.commands().set(machine, {0.5, 0.1, false});
  for (int i = 0; i < 60; ++i) world.step();
  EXPECT_GT(boom.velocity(), 0);
  EXPECT_GT(wheel.state().force_W.z(), 0);
  EXPECT_EQ(machine.drive().steer, 0.1);
  EXPECT_EQ(boom.position(), world.outputs().get("excavator/boom_joint/position"));
  EXPECT_EQ(boom.state().cylinder_force,
            world.outputs().get("excavator/boom_joint/cylinder_force"));
  EXPECT_EQ(machine.link(0).pose().translation().x(), world.outputs().get("excavator/pose/x"));
  EXPECT_EQ(machine.link(0).velocity().z(), world.outputs().get("excavator/velocity/z"));
  EXPECT_EQ(wheel.state().slip, world.outputs().get("excavator/" + wheel.name() + "/slip"));
  EXPECT_EQ(bucket.force().z(), world.outputs().get("excavator/bucket/force_z"));
  EXPECT_EQ(bucket.rock_force().z(), world.outputs().get("excavator/bucket/rock_force_z"));
  EXPECT_EQ(bucket.payload(), world.outputs().get("excavator/bucket/payload"));
  EXPECT_EQ(machine.pump().flow, world.outputs().get("excavator/pump/flow"));
  // The engine's own result, for a link that is not the base.
  const LinkHandle stick = machine.link("stick");
  const vehicle::LinkState state = parts(world).coupling.engine(0).link(
      parts(world).coupling.index(0), machine.description().link_index("stick"));
  EXPECT_EQ(stick.pose().matrix(), state.X_WL.matrix());
  EXPECT_EQ(stick.angular_velocity(), state.w_WL);
  EXPECT_GT(machine.work(), 0);
  EXPECT_TRUE(bucket.is_bucket());
  EXPECT_FALSE(bucket.is_bed());
}

TEST_F(Handles, SuggestTheNearestForAnUnknownName) {
  const World world(testing::load("trench.sdf"), device_);
  const MachineHandle machine = world.machines().at(0);
  EXPECT_NE(failure([&] { world.machines().at("excavater"); }).find("'excavator'"),
            std::string::npos);
  EXPECT_NE(failure([&] { machine.link("bom"); }).find("'boom'"), std::string::npos);
  EXPECT_NE(failure([&] { machine.joint("boom_join"); }).find("'boom_joint'"), std::string::npos);
  EXPECT_NE(failure([&] { machine.tool("buckett"); }).find("'bucket'"), std::string::npos);
  EXPECT_NE(failure([&] { world.machines().at(1); }).find("there are 1, counted from 0"),
            std::string::npos);
  EXPECT_NE(failure([&] { machine.wheel(-1); }).find("no wheel of this index"), std::string::npos);
}

TEST_F(Handles, ReadWithoutAllocating) {
  World world(testing::load("trench.sdf"), device_);
  const MachineHandle machine = world.machines().at("excavator");
  const LinkHandle link = machine.link("boom");
  const JointHandle joint = machine.joint("arm_joint");
  const WheelHandle wheel = machine.wheel(1);
  const ToolHandle tool = machine.tool("bucket");
  world.step();
  const std::uint64_t before = allocations;
  double sum = link.pose().translation().z() + link.velocity().x() + joint.position() +
               joint.state().effort_limit + wheel.state().slip + tool.force().x() +
               tool.momentum_balance().scale + machine.pump().pressure + machine.work() +
               machine.drive().speed;
  sum += static_cast<double>(machine.name().size() + tool.name().size());
  EXPECT_EQ(allocations - before, 0u) << sum;
}

TEST_F(Handles, StayValidThroughALoadedSnapshot) {
  World world(testing::load("bucket_path.sdf"), device_);
  const JointHandle slide = world.machines().at("bucket").joint("slide_x");
  const std::vector<char> bytes = saved(world);
  const double start = slide.position();
  world.commands().set(slide, {vehicle::JointMode::kVelocity, 0.5});
  for (int i = 0; i < 20; ++i) world.step();
  EXPECT_GT(slide.position(), start);
  load_saved(bytes, world);
  EXPECT_EQ(slide.position(), start);
}

}  // namespace
}  // namespace navvy::sim
