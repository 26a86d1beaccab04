// SPDX-License-Identifier: Apache-2.0
// A device without memory, at every buffer that a dig allocates: the ledger stays balanced, and the
// state remains usable.
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include "device/device_error.h"
#include "soil/rig.h"

namespace {

/// Buffers requested since `refuse` was set.
long made = 0;
/// Number of the refused one, from 1; 0: none.
long refuse = 0;
bool refused = false;

}  // namespace

/// Replaces the loader's function of this name, which every buffer of this program uses.
extern "C" void* clCreateBuffer(void* context, std::uint64_t flags, std::size_t size, void* host,
                                std::int32_t* result) {
  using Function = void* (*)(void*, std::uint64_t, std::size_t, void*, std::int32_t*);
  static const auto real = reinterpret_cast<Function>(dlsym(RTLD_NEXT, "clCreateBuffer"));
  if (++made != refuse) return real(context, flags, size, host, result);
  refused = true;
  *result = -4;  // CL_MEM_OBJECT_ALLOCATION_FAILURE
  return nullptr;
}

namespace navvy::soil {
namespace {

/// A blade that digs through two metres of sand and pushes the soil before it over the site's edge:
/// soil becomes active, is sorted again and leaves, and the lists near the blade grow.
class Dig {
 public:
  Dig()
      : site_(rig::Rig::device(), {rig::sand()}, 0.2, options()),
        tool_(site_.add_tool(rig::blade(0.6, 0.5), start())) {
    site_.tool(tool_).motion.v_WT = Vec3(2, 0, 0);
  }
  void run() { site_.run(0.8); }
  Solver& solver() { return site_.solver(); }
  std::int64_t left() { return site_.solver().ledger().left_site.at(0); }

 private:
  static Pose start() { return make_pose(0.5, 1.0, -0.25); }
  static lab::SiteOptions options() {
    lab::SiteOptions out;
    out.size = 2;
    out.corner = Vec2::Zero();
    out.exchange = true;
    return out;
  }
  lab::Site site_;
  int tool_;
};

TEST(SoilMemory, AnyBufferThatTheDeviceRefusesLeavesABalancedLedgerAndAUsableState) {
  made = refuse = 0;
  {
    Dig whole;
    whole.run();
    ASSERT_GT(whole.left(), 0) << "some soil went over the edge";
    ASSERT_GT(whole.solver().stats().rebins, 2u);
    ASSERT_GT(whole.solver().stats().activations, 10u);
  }
  const long all = made;
  int of_solver = 0, of_steps = 0;
  Dig larger;
  // Every other one: all of them took half a minute, and passed once.
  for (long n = 1; n <= all; n += 2) {
    made = 0, refuse = n, refused = false;
    std::unique_ptr<Dig> dig;
    std::string said;
    try {
      dig = std::make_unique<Dig>();
      dig->run();
    } catch (const device::DeviceError& error) {
      said = error.what();
    }
    ASSERT_TRUE(refused) << n;
    ASSERT_NE(said.find("clCreateBuffer"), std::string::npos) << n << ": " << said;
    ++(dig ? of_steps : of_solver);
    if (!dig) continue;
    ASSERT_NE(said.find("soil step"), std::string::npos) << n << ": " << said;
    ASSERT_EQ(dig->solver().ledger().error(), 0) << n << ": " << said;
    // As in a snapshot: every particle, on a device with enough memory.
    refuse = 0;
    load_saved(saved(dig->solver()), larger.solver());
    ASSERT_EQ(larger.solver().particles().size(), dig->solver().particles().size())
        << n << ": " << said;
    ASSERT_EQ(hash_of(larger.solver()).digest(), hash_of(dig->solver()).digest())
        << n << ": " << said;
  }
  std::printf("%ld buffers, %d of the solver itself, %d in its steps\n", all, of_solver, of_steps);
  EXPECT_GT(of_steps, 30);
}

}  // namespace
}  // namespace navvy::soil
