// SPDX-License-Identifier: Apache-2.0
// The short version of `./dev soak`, and checks that it detects faults.
#include "soak/soak.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <memory>

#include "folder.h"
#include "text_of.h"

namespace navvy::soak {
namespace {

Phase phase(long cycle, std::int64_t heap) {
  Phase out;
  out.cycle = cycle;
  out.time = static_cast<double>(cycle) * 10;
  out.process = 1;
  out.bytes = {heap, 50'000'000, 8'000'000};
  out.hash = "0123456789abcdef";
  return out;
}

/// Returns forty cycles whose memory grows in the first ten and is flat from then on.
std::vector<Phase> sound() {
  std::vector<Phase> out;
  for (long i = 1; i <= 40; ++i) out.push_back(phase(i, 10'000'000 + 50'000 * std::min(i, 10L)));
  return out;
}

TEST(SoakClaims, HoldForBytesThatGrowInTheFirstQuarterOnly) {
  EXPECT_TRUE(broken_claims(sound()).empty());
  EXPECT_EQ(growth(sound()).heap, 0);
}

TEST(SoakClaims, ReportALeakOfSixteenKibibytesPerCycle) {
  std::vector<Phase> rows = sound();
  for (Phase& row : rows) row.bytes.heap += 16384 * row.cycle;
  ASSERT_EQ(broken_claims(rows).size(), 1u);
  EXPECT_NE(broken_claims(rows)[0].find("malloc grew by 491520 bytes"), std::string::npos)
      << broken_claims(rows)[0];
}

TEST(SoakClaims, ReportAnAdditionalBufferOnTheDevice) {
  std::vector<Phase> rows = sound();
  rows.back().bytes.device += 4096;
  ASSERT_EQ(broken_claims(rows).size(), 1u);
  EXPECT_NE(broken_claims(rows)[0].find("device"), std::string::npos);
}

TEST(SoakClaims, ReportALedgerThatIsOffByOneUnit) {
  std::vector<Phase> rows = sound();
  rows[17].ledger = 1;
  ASSERT_EQ(broken_claims(rows).size(), 1u);
  EXPECT_NE(broken_claims(rows)[0].find("off by 1 units after cycle 18"), std::string::npos);
}

TEST(SoakClaims, CompareAProcessOnlyWithItself) {
  // The second process began with 9 MB more, which is no growth; its own growth is.
  std::vector<Phase> rows = sound();
  for (Phase row : sound()) {
    row.cycle += 40;
    row.process = 2;
    row.bytes.heap += 9'000'000;
    rows.push_back(row);
  }
  EXPECT_TRUE(broken_claims(rows).empty());
  rows.back().bytes.heap += 300'000;
  EXPECT_EQ(broken_claims(rows).size(), 1u);
}

TEST(SoakTable, SkipsARowTruncatedByAKill) {
  const test::Folder folder;
  write_phases(folder / "phases.csv", sound());
  std::ofstream(folder / "phases.csv", std::ios::app) << "41,410.000,8.1,1,1050";
  const std::vector<Phase> rows = read_phases(folder / "phases.csv");
  ASSERT_EQ(rows.size(), 40u);
  EXPECT_EQ(rows[39].bytes.heap, sound()[39].bytes.heap);
  EXPECT_EQ(rows[39].hash, sound()[39].hash);
}

/// Returns a plan of a few cycles. Bytes still grow by the cases of the first scoops, the lists of
/// particles that are added and removed among them: 0.61 MiB on the heap and buffers of 0.26 MiB on
/// the device, which is the allowance here. In 40 cycles they are flat from the 15th on.
Plan few(const std::string& folder, long cycles) {
  Plan plan;
  plan.folder = folder;
  plan.cycles = cycles;
  plan.allowance = {768 * 1024, 2 * 1024 * 1024, 384 * 1024, 4};
  return plan;
}

TEST(Soak, FourCyclesHaveFlatMemoryAndMatchFourResumedQuarters) {
  const test::Folder folder;
  device::Device device;
  const Plan plan = few(folder / "soak", 4);
  const Result result = soak(device, plan);
  std::printf("%s", summary(result, plan).c_str());
  EXPECT_TRUE(result.broken.empty()) << result.broken.front();
  EXPECT_EQ(result.reached, 4);
  EXPECT_EQ(result.compared, 4);
  EXPECT_EQ(result.processes, 1);
  EXPECT_GT(result.most.heap, 1'000'000);
  EXPECT_GT(result.most.device, 100'000);
  std::vector<Phase> rows = read_phases(folder / "soak/phases.csv");
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_NE(rows[2].hash, rows[3].hash) << "it digs";
  EXPECT_NE(test::text_of(folder / "soak/bytes.svg").find("</svg>"), std::string::npos);

  // If the run had another state there, the quarters would differ.
  rows[1].hash = "ffffffffffffffff";
  write_phases(folder / "soak/phases.csv", rows);
  std::filesystem::remove(folder / "soak/quarter.snapshot");
  const Result parted = soak(device, plan);
  ASSERT_EQ(parted.broken.size(), 1u);
  EXPECT_NE(parted.broken[0].find("after cycle 2"), std::string::npos) << parted.broken[0];
  EXPECT_EQ(parted.compared, 2);
}

TEST(Soak, ResumesFromAnyPartAndReportsALeakPerCycle) {
  const test::Folder folder;
  device::Device device;
  // Stopped after each cycle, in the long run and in the quarters.
  Plan plan = few(folder / "pieces", 4);
  int asked = 0;
  plan.stop = [&] { return ++asked % 2 == 0; };
  Result pieces;
  for (int i = 0; i < 40 && pieces.compared < 4; ++i) pieces = soak(device, plan);
  EXPECT_EQ(pieces.reached, 4);
  EXPECT_EQ(pieces.compared, 4) << "four fresh sessions reach the hash of the resumed run";
  EXPECT_EQ(pieces.processes, 4);
  EXPECT_TRUE(pieces.broken.empty()) << pieces.broken.front();

  // A longer plan continues the folder; memory leaks in each of its cycles.
  plan.cycles = 8;
  plan.stop = [&] { return read_phases(folder / "pieces/phases.csv").back().cycle == 8; };
  std::vector<std::unique_ptr<char[]>> leaks;
  plan.after_cycle = [&](long) { leaks.push_back(std::make_unique<char[]>(400'000)); };
  const Result leaking = soak(device, plan);
  EXPECT_EQ(leaking.reached, 8);
  ASSERT_FALSE(leaking.broken.empty());
  EXPECT_NE(leaking.broken[0].find("memory allocated by malloc grew"), std::string::npos)
      << leaking.broken[0];
}

}  // namespace
}  // namespace navvy::soak
