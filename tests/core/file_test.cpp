// SPDX-License-Identifier: Apache-2.0
#include "core/file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include "core/error.h"
#include "folder.h"

namespace navvy {
namespace {
namespace fs = std::filesystem;

/// A fresh folder that goes with the test.
class File : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return folder_ / name; }
  static std::string text(const std::string& path) {
    const std::vector<char> bytes = read_file(path);
    return {bytes.begin(), bytes.end()};
  }

 private:
  const test::Folder folder_;
};

std::string message(const std::function<void()>& action) {
  try {
    action();
  } catch (const FileError& error) {
    return error.what();
  }
  return "";
}

TEST_F(File, IsReplacedAsAWholeAndLeavesNoPart) {
  write_file_atomically(path("a"), std::string("old"));
  write_file_atomically(path("a"), std::string("new\0text", 8));
  EXPECT_EQ(text(path("a")), std::string("new\0text", 8));
  EXPECT_FALSE(fs::exists(partial_name(path("a"))));
}

TEST_F(File, MayBeEmpty) {
  write_file_atomically(path("a"), std::vector<char>{});
  EXPECT_EQ(text(path("a")), "");
}

TEST_F(File, IsReadOnlyWhenItIsPlainAndOnlySoFar) {
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  fs::create_symlink("/dev/zero", path("zero"));
  EXPECT_EQ(message([&] { read_file(path("pipe")); }),
            "cannot read '" + path("pipe") + "': it is a pipe, a plain file is needed");
  EXPECT_NE(message([&] { read_file(path("zero")); }).find("it is a device"), std::string::npos);
  EXPECT_NE(message([&] { read_file(path("")); }).find("it is a directory"), std::string::npos);
  write_file_atomically(path("a"), std::string("12345"));
  EXPECT_EQ(read_file(path("a"), 5).size(), 5u);
  EXPECT_NE(message([&] { read_file(path("a"), 4); }).find("it has more than 4 bytes"), std::string::npos);
}

TEST_F(File, KeepsItsOldContentWhenTheDiskIsFull) {
  write_file_atomically(path("a"), std::string("old"));
  // The neighbour that is written first leads to a device that is always full.
  fs::create_symlink("/dev/full", partial_name(path("a")));
  const std::string said = message([&] { write_file_atomically(path("a"), std::string("new")); });
  EXPECT_EQ(said, "cannot write '" + partial_name(path("a")) + "': No space left on device");
  EXPECT_EQ(text(path("a")), "old");
  EXPECT_FALSE(fs::is_symlink(partial_name(path("a"))));
}

TEST_F(File, KeepsItsOldContentWhenItIsCutInTheMiddle) {
  write_file_atomically(path("a"), std::string("old"));
  // A limit on file size lets the first 4 KiB through and fails the rest, as a disk that fills up does.
  rlimit old{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &old), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit small = old;
  small.rlim_cur = 4096;
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  const std::string said = message([&] { write_file_atomically(path("a"), std::string(100000, 'x')); });
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &old), 0);
  std::signal(SIGXFSZ, handler);
  EXPECT_NE(said.find("cannot write"), std::string::npos) << said;
  EXPECT_EQ(text(path("a")), "old");
  EXPECT_FALSE(fs::exists(partial_name(path("a"))));
}

TEST_F(File, NamesPathAndCauseWhenItCannotBeReachedOrRead) {
  EXPECT_EQ(message([&] { read_file(path("absent")); }),
            "cannot read '" + path("absent") + "': No such file or directory");
  EXPECT_EQ(message([&] { read_file(path("")); }),
            "cannot read '" + path("") + "': it is a directory, a plain file is needed");
  EXPECT_EQ(message([&] { write_file_atomically(path("no/where"), std::string("x")); }),
            "cannot create '" + path("no/where.part") + "': No such file or directory");
}

TEST_F(File, RemovesItsPartWhenTheNameIsTaken) {
  fs::create_directories(path("folder/inside"));
  EXPECT_NE(message([&] { write_file_atomically(path("folder"), std::string("x")); }).find("cannot rename to"),
            std::string::npos);
  EXPECT_FALSE(fs::exists(partial_name(path("folder"))));
}

TEST_F(File, IsCommittedFromAPartAnotherLibraryWrote) {
  std::ofstream(partial_name(path("a"))) << "written by a library";
  commit_file(path("a"));
  EXPECT_EQ(text(path("a")), "written by a library");
  EXPECT_NE(message([&] { commit_file(path("a")); }).find("cannot open"), std::string::npos);
}

}  // namespace
}  // namespace navvy
