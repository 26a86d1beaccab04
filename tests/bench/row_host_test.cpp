// SPDX-License-Identifier: Apache-2.0
#include "bench/row.h"
#include "folder.h"
#include "paths.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <string>

namespace navvy::bench {
namespace {

Row example() {
  Row row;
  row.bench = "soil_dig:29k";
  row.device = "A \"fast\", new device";
  row.driver = "3.1";
  row.particles = 1000;
  row.steps = 10;
  row.timing = {0.5, 0.6, 0.2, 3};
  row.kernels = 0.4;
  row.bytes_per_particle = 200;
  row.flops_per_particle = 1300;
  row.simulated = 0.25;
  row.hash = "0123456789abcdef";
  row.peak = {8e6, 1e8};
  return row;
}

std::string cell(const Row& row, const std::string& column) {
  const auto at = std::find(columns().begin(), columns().end(), column);
  return at == columns().end() ? "no such column"
                               : cells(row)[static_cast<std::size_t>(at - columns().begin())];
}

TEST(BenchRow, RatesAndSharesFollowFromTheFastestRun) {
  const Row row = example();
  EXPECT_EQ(cell(row, "min_ms"), "500.0000");
  EXPECT_EQ(cell(row, "median_ms"), "600.0000");
  EXPECT_EQ(cell(row, "particle_steps_per_s"), "2e+04");
  EXPECT_EQ(cell(row, "share_of_copy_bandwidth"), "0.500");  // 2e4 x 200 / 8e6
  EXPECT_EQ(cell(row, "share_of_fma_peak"), "0.260");        // 2e4 x 1300 / 1e8
  EXPECT_EQ(cell(row, "real_time_factor"), "0.500");
  EXPECT_EQ(cell(row, "kernel_ms"), "400.0000");
  EXPECT_EQ(cell(row, "kernel_particle_steps_per_s"), "2.5e+04");
}

TEST(BenchRow, LeavesUnmeasuredFieldsEmpty) {
  Row row = example();
  row.peak = {};
  row.simulated = 0;
  row.kernels = 0;
  for (const char* column : {"share_of_copy_bandwidth", "share_of_fma_peak", "real_time_factor",
                             "site_m", "kernel_ms", "kernel_particle_steps_per_s"})
    EXPECT_EQ(cell(row, column), "") << column;
}

TEST(BenchRow, EveryLineHasAsManyFieldsAsTheHeader) {
  const auto fields = [](const std::string& line) {
    std::size_t count = 1;
    bool quoted = false;
    for (const char c : line) {
      quoted = quoted != (c == '"');
      count += c == ',' && !quoted ? 1 : 0;
    }
    return count;
  };
  EXPECT_EQ(fields(csv_header()), columns().size());
  EXPECT_EQ(fields(csv_line(example())), columns().size());
  EXPECT_EQ(fields(csv_line(Row{})), columns().size());
}

TEST(BenchRow, JsonKeepsNumbersAsNumbersAndTextAsText) {
  const std::string text = json({example(), example()});
  EXPECT_NE(text.find("\"particles\": 1000,"), std::string::npos) << text;
  EXPECT_NE(text.find("\"state_hash\": \"0123456789abcdef\""), std::string::npos) << text;
  EXPECT_NE(text.find("\"device\": \"A 'fast', new device\""), std::string::npos) << text;
  EXPECT_EQ(text.find("site_m"), std::string::npos) << "unmeasured values are omitted";
}

TEST(BenchCompare, PrintsTheRatioAndMarksAnotherHash) {
  const test::Folder folder;
  const std::string a = folder / "a.csv", b = folder / "b.csv";
  if (std::system("python3 -c 'pass' 2>/dev/null") != 0) GTEST_SKIP() << "no python3";
  Row other = example();
  other.timing.best = 0.25;
  other.hash = "f";
  std::ofstream(a) << csv_header() << "\n" << csv_line(example()) << "\n";
  std::ofstream(b) << csv_header() << "\n" << csv_line(other) << "\n";
  const std::string out = folder / "compare.txt";
  const std::string command =
      "python3 " + navvy::source_dir() + "/bench/compare.py " + a + " " + b + " >" + out;
  ASSERT_EQ(std::system(command.c_str()), 0);
  std::string text, line;
  for (std::ifstream file(out); std::getline(file, line);) text += line + "\n";
  EXPECT_NE(text.find("0.500  state hash differs"), std::string::npos) << text;
}

}  // namespace
}  // namespace navvy::bench
