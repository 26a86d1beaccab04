// SPDX-License-Identifier: Apache-2.0
// The rows of a day, written directly without a simulation.
#include "record/row_file.h"

#include <gtest/gtest.h>
#include <malloc.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "core/error.h"
#include "core/file.h"
#include "folder.h"
#include "text_of.h"

namespace navvy::record {
namespace {

namespace fs = std::filesystem;

using test::text_of;

/// Returns the bytes that this process has written so far.
std::uint64_t bytes_written() {
  std::ifstream io("/proc/self/io");
  std::string name;
  std::uint64_t value = 0;
  while (io >> name >> value)
    if (name == "wchar:") return value;
  return 0;
}

/// Returns a row as long as those of the trench, identified by its number.
std::string row_of(std::uint64_t number, std::size_t length = 760) {
  std::string row = std::to_string(number);
  row.resize(length, ',');
  return row;
}

TEST(RowFile, WritesEachByteOnceAndBuffersLittle) {
  const test::Folder folder;
  RowFile file(folder / "rows.csv", "header");
  std::uint64_t expected = 7;
  const std::uint64_t before = bytes_written();
  constexpr std::uint64_t kRows = 60'000;  // 20 minutes at 50 Hz
  for (std::uint64_t i = 0; i < kRows; ++i) {
    const std::string row = row_of(i);
    file.add(row);
    expected += row.size() + 1;
    // Like checkpoints: occasionally, and then not at all for a long while.
    if (i % 97 == 0 && i < kRows / 2) file.flush();
    ASSERT_LT(file.waiting(), RowFile::kMostWaiting);
    ASSERT_EQ(file.written() + file.waiting(), expected);
  }
  file.sync();
  EXPECT_EQ(file.rows(), kRows);
  EXPECT_EQ(fs::file_size(folder / "rows.csv"), expected);
  // One percent for the test's own output.
  const std::uint64_t written = bytes_written() - before;
  ASSERT_GT(written, 0u);
  EXPECT_LT(written, expected + expected / 100);
}

/// A run's memory after a day equals that at its start: strings that grow with the longest wait
/// would look like a leak.
TEST(RowFile, MemoryDoesNotGrowWithPendingRows) {
  const test::Folder folder;
  RowFile file(folder / "rows.csv", "number");
  file.flush();
  const std::string row(200, '7');
  const auto in_use = [] {
    const struct mallinfo2 info = mallinfo2();
    return info.uordblks + info.hblkhd;
  };
  const std::size_t before = in_use();
  for (int i = 0; i < 20'000; ++i) file.add(row);
  EXPECT_EQ(in_use(), before);
  EXPECT_GT(file.written(), 3 * RowFile::kMostWaiting);
}

TEST(RowFile, KeepsTheRowsInOrder) {
  const test::Folder folder;
  // A kill truncated the earlier run's last row: nothing is appended after it.
  write_file_atomically(folder / "rows.csv",
                        std::string("of an earlier run,\nlonger than what comes now, and to"));
  {
    RowFile file(folder / "rows.csv", "a,b");
    file.flush();
    EXPECT_EQ(text_of(folder / "rows.csv"), "a,b\n");
    file.add("1,2");
    file.flush();
    file.flush();
    file.add("3,4");
    EXPECT_EQ(text_of(folder / "rows.csv"), "a,b\n1,2\n");
    file.sync();
  }
  EXPECT_EQ(text_of(folder / "rows.csv"), "a,b\n1,2\n3,4\n");
}

TEST(RowFile, EndsWithAWholeRowOnAFullDiskAndContinuesWhenThereIsSpace) {
  const test::Folder folder;
  RowFile file(folder / "rows.csv", "header");
  file.add(row_of(0));
  file.sync();
  const std::string before = text_of(folder / "rows.csv");
  // Space for half a row: the system accepts this much and refuses the rest.
  rlimit limit{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &limit), 0);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit tight = limit;
  tight.rlim_cur = before.size() + 380;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &tight), 0);
  file.add(row_of(1));
  EXPECT_THROW(file.flush(), FileError);
  EXPECT_THROW(file.sync(), FileError);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &limit), 0);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_EQ(text_of(folder / "rows.csv"), before);
  file.sync();
  EXPECT_EQ(text_of(folder / "rows.csv"), before + row_of(1) + "\n");
}

TEST(RowFile, ReportsAMissingFolder) {
  const test::Folder folder;
  RowFile file(folder / "none/rows.csv", "header");
  EXPECT_THROW(file.flush(), FileError);
}

TEST(RowFile, StaysWithItsFileWhenTheFolderIsRenamed) {
  const test::Folder folder;
  fs::create_directory(folder / "out");
  RowFile file(folder / "out/rows.csv", "header");
  file.flush();
  fs::rename(folder / "out", folder / "out.previous");
  file.add("1");
  file.sync();
  EXPECT_EQ(text_of(folder / "out.previous/rows.csv"), "header\n1\n");
}

TEST(RowFile, HasCompleteRowsAndAtMostOneTruncatedAfterAKill) {
  const test::Folder folder;
  const std::string path = folder / "rows.csv";
  int with_rows = 0;
  for (int i = 0; i < 20; ++i) {
    fs::remove(path);
    const pid_t child = fork();
    if (child == 0) {
      RowFile file(path, "header");
      for (std::uint64_t n = 0;; ++n) {
        file.add(row_of(n, 20'000));
        if (n % 20 == 0) file.flush();
      }
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2 + 3 * i));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    if (!fs::exists(path)) continue;
    std::istringstream lines(text_of(path));
    std::string line;
    ASSERT_TRUE(std::getline(lines, line));
    EXPECT_EQ(line, "header");
    // Lines with a line end are complete rows, without a gap.
    for (std::uint64_t n = 0; std::getline(lines, line) && !lines.eof(); ++n) {
      ASSERT_EQ(line, row_of(n, 20'000)) << n;
      ++with_rows;
    }
  }
  EXPECT_GT(with_rows, 0) << "every kill came before the first row";
}

}  // namespace
}  // namespace navvy::record
