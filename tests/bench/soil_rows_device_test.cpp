// SPDX-License-Identifier: Apache-2.0
#include "bench/soil_rows.h"

#include <gtest/gtest.h>

#include "bench/measure.h"
#include "core/error.h"
#include "device/device.h"

namespace navvy::bench {
namespace {

const SoilCase& find(const std::string& name) {
  for (const SoilCase& c : soil_cases())
    if (c.name == name) return c;
  throw Error("no case " + name);
}

TEST(SoilRows, TheSameCaseTwiceDoesTheSameWork) {
  device::Device device;
  const SoilCase& collapse = find("soil_collapse:8k");
  const Row first = collapse.run(device), second = collapse.run(device);
  EXPECT_EQ(first.hash, second.hash);
  EXPECT_EQ(first.particles, 8000u);
  EXPECT_LE(first.timing.best, first.timing.median);
}

// Ground and soil are restored together between runs: otherwise the ledger of mass opens in the second one.
TEST(SoilRows, ADigWithWakingGroundRepeats) {
  device::Device device;
  const Row row = find("site_dig:0.01km2").run(device);
  EXPECT_GT(row.particles, 1000u);
  EXPECT_EQ(row.site, 100);
}

TEST(Peak, IsWithinWhatAnyDeviceCanDo) {
  device::Device device;
  const double flops = fma_peak(device), copy = copy_bandwidth(device, std::size_t{1} << 24);
  EXPECT_TRUE(flops > 1e8 && flops < 1e15) << flops;
  EXPECT_TRUE(copy > 1e7 && copy < 1e14) << copy;
}

TEST(SoilRows, AnUnknownNameIsRefusedWithTheKnownOnes) {
  device::Device device;
  try {
    run_soil_cases(device, "no such case", false, [](const Row&) {});
    FAIL() << "nothing was thrown";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("soil_held_bucket"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace navvy::bench
