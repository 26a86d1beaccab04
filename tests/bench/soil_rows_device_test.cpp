// SPDX-License-Identifier: Apache-2.0
#include "bench/soil_rows.h"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "bench/measure.h"
#include "bench/native_rows.h"
#include "core/error.h"
#include "device/device.h"
#include "lab/soils.h"

namespace navvy::bench {
namespace {

// Ground and soil must be restored together between runs; otherwise the mass ledger has an error
// and the solver stops.
TEST(SoilRows, TheSameCaseTwiceDoesTheSameWork) {
  device::Device device;
  for (const SoilCase& c : soil_cases()) {
    if (c.name != "soil_collapse_no_tool:8k" && c.name != "site_dig:0.01km2") continue;
    const Row first = c.run(device, bench_sand()), second = c.run(device, bench_sand());
    EXPECT_EQ(first.hash, second.hash) << c.name;
    EXPECT_EQ(first.particles, second.particles) << c.name;
  }
}

TEST(SoilRows, FillsEveryColumnOfItsRows) {
  device::Device device;
  std::vector<Row> rows;
  run_soil_cases(device, {"", true}, [&](const Row& row) { rows.push_back(row); });
  std::set<std::string> hashes;
  std::size_t quick = 0;
  for (const SoilCase& c : soil_cases()) quick += c.quick ? 1 : 0;
  ASSERT_EQ(rows.size(), quick);
  for (const Row& row : rows) {
    SCOPED_TRACE(row.bench);
    EXPECT_EQ(row.device, device.info().name);
    EXPECT_EQ(row.driver, device.info().driver);
    EXPECT_GT(row.timing.best, 0);
    EXPECT_LE(row.timing.best, row.timing.median);
    EXPECT_GT(row.kernels, 0);
    EXPECT_EQ(row.timing.runs, 3);
    EXPECT_GT(row.peak.copy_bandwidth, 0);
    EXPECT_GT(row.peak.flops, 0);
    // Steps of the scenes: 2.4 ms at most, and not less than a tenth of it for these soils.
    EXPECT_GT(row.simulated / static_cast<double>(row.steps), 2.4e-4);
    EXPECT_LE(row.simulated / static_cast<double>(row.steps), 2.4e-3 + 1e-12);
    EXPECT_EQ(row.site > 0, row.bench.rfind("site_", 0) == 0);
    // A size in the name is the number of particles: 8k is 7500 to 8500.
    const std::size_t colon = row.bench.find(':'), k = row.bench.find('k', colon);
    if (colon != std::string::npos && k == row.bench.size() - 1)
      EXPECT_NEAR(static_cast<double>(row.particles), 1000 * std::stod(row.bench.substr(colon + 1)),
                  500);
    EXPECT_GT(row.particles, 1000u);
    EXPECT_GT(row.active_blocks, 27);
    // Only blocks near a tool have contact nodes, 64 each.
    EXPECT_EQ(row.contact_nodes > 0, row.bench.find("no_tool") == std::string::npos);
    EXPECT_LE(row.contact_nodes, 64 * row.active_blocks);
    EXPECT_EQ(row.hash.size(), 16u);
    EXPECT_TRUE(hashes.insert(row.hash).second) << "two cases have the same final state";
  }
}

TEST(SoilRows, SelectsTheCasesWhoseNamesContainAWord) {
  device::Device device;
  std::vector<std::string> names;
  run_soil_cases(device, {"held"}, [&](const Row& row) { names.push_back(row.bench); });
  EXPECT_EQ(names, std::vector<std::string>{"soil_held_bucket"});
}

TEST(SoilRows, OfAnotherSoilCarryItsNameAndAnotherResult) {
  device::Device device;
  scene::Soil clay = lab::cohesive(20, 5000);
  clay.name = "clay";
  std::vector<Row> rows;
  const auto keep = [&](const Row& row) { rows.push_back(row); };
  run_soil_cases(device, {"held"}, keep);
  run_soil_cases(device, {"held", false, clay}, keep);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[1].bench, "soil_held_bucket@clay");
  EXPECT_NE(rows[0].hash, rows[1].hash);
}

TEST(NativeRows, ComeInPairsOfOneState) {
  device::Device device;
  std::vector<Row> rows;
  run_native_cases(device, {"8k"}, [&](const Row& row) { rows.push_back(row); });
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].bench, "native_loop:8k");
  EXPECT_EQ(rows[1].bench, "soil_collapse_no_tool:8k");
  EXPECT_EQ(rows[0].particles,
            rows[1].particles * static_cast<std::uint64_t>(device.info().compute_units));
  EXPECT_EQ(rows[0].simulated, rows[1].simulated);
  for (const Row& row : rows) EXPECT_GT(row.peak.flops, 0) << row.bench;
  const NativeRatio ratio = native_ratio(rows[0], rows[1]);
  // Both are loops of the same method; a factor of ten means that one of them did not run.
  EXPECT_TRUE(ratio.wall > 0.1 && ratio.wall < 10) << ratio.wall;
  EXPECT_TRUE(ratio.processor > 0.1 && ratio.processor < 10) << ratio.processor;
}

TEST(Peak, IsWithinTheRangeOfRealDevices) {
  device::Device device;
  const double flops = fma_peak(device), copy = copy_bandwidth(device, std::size_t{1} << 24);
  EXPECT_TRUE(flops > 1e8 && flops < 1e15) << flops;
  EXPECT_TRUE(copy > 1e7 && copy < 1e14) << copy;
}

TEST(SoilRows, AnUnknownNameIsRefusedWithTheKnownOnes) {
  device::Device device;
  try {
    run_soil_cases(device, {"no such case"}, [](const Row&) {});
    FAIL() << "no exception was thrown";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("soil_held_bucket"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace navvy::bench
