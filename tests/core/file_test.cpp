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
#include <utility>

#include "core/error.h"
#include "folder.h"

namespace navvy {
namespace {
namespace fs = std::filesystem;

/// Creates a fresh folder that is removed with the test.
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

TEST_F(File, IsReplacedAtomicallyAndLeavesNoTemporaryFile) {
  write_file_atomically(path("a"), std::string("old"));
  write_file_atomically(path("a"), std::string("new\0text", 8));
  EXPECT_EQ(text(path("a")), std::string("new\0text", 8));
  EXPECT_FALSE(fs::exists(partial_name(path("a"))));
}

TEST_F(File, MayBeEmpty) {
  write_file_atomically(path("a"), std::vector<char>{});
  EXPECT_EQ(text(path("a")), "");
}

TEST_F(File, IsReadOnlyIfRegularAndUpToItsLimit) {
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  fs::create_symlink("/dev/zero", path("zero"));
  EXPECT_EQ(message([&] { read_file(path("pipe")); }),
            "cannot read '" + path("pipe") + "': it is a pipe, a plain file is needed");
  EXPECT_NE(message([&] { read_file(path("zero")); }).find("it is a device"), std::string::npos);
  EXPECT_NE(message([&] { read_file(path("")); }).find("it is a directory"), std::string::npos);
  write_file_atomically(path("a"), std::string("12345"));
  EXPECT_EQ(read_file(path("a"), 5).size(), 5u);
  EXPECT_NE(message([&] { read_file(path("a"), 4); }).find("it has more than 4 bytes"),
            std::string::npos);
}

TEST_F(File, KeepsItsOldContentWhenTheDiskIsFull) {
  write_file_atomically(path("a"), std::string("old"));
  // The temporary file that is written first is a link to a device that is always full.
  fs::create_symlink("/dev/full", partial_name(path("a")));
  const std::string said = message([&] { write_file_atomically(path("a"), std::string("new")); });
  EXPECT_EQ(said, "cannot write '" + partial_name(path("a")) + "': No space left on device");
  EXPECT_EQ(text(path("a")), "old");
  EXPECT_FALSE(fs::is_symlink(partial_name(path("a"))));
}

TEST_F(File, KeepsItsOldContentWhenWritingFailsHalfway) {
  write_file_atomically(path("a"), std::string("old"));
  // A limit on the file size lets the first 4 KiB through and fails the rest, like a disk that
  // fills up.
  rlimit old{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &old), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit small = old;
  small.rlim_cur = 4096;
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  const std::string said =
      message([&] { write_file_atomically(path("a"), std::string(100000, 'x')); });
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
            "cannot write '" + path("no/where") + "': there is no folder '" + path("no") +
                "' (create it: mkdir -p '" + path("no") + "')");
  EXPECT_NE(message([&] { require_writable(path("no/where")); }).find("mkdir -p"),
            std::string::npos);
}

TEST_F(File, DoesNotReplacePipesDevicesOrFolders) {
  fs::create_directories(path("folder/inside"));
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  ASSERT_EQ(::mkfifo(path("hidden").c_str(), 0600), 0);
  fs::create_symlink("hidden", path("link"));
  fs::create_symlink("/dev/full", path("full"));
  const std::pair<std::string, std::string> all[] = {
      {"folder", "a directory"}, {"pipe", "a pipe"}, {"link", "a pipe"}, {"full", "a device"}};
  for (const auto& each : all) {
    // A lambda cannot capture a structured binding.
    const std::string &name = each.first, &what = each.second;
    const std::string expected = "cannot write '" + path(name) + "': it is " + what +
                                 ", and only a plain file can be replaced (name a file)";
    EXPECT_EQ(message([&] { write_file_atomically(path(name), std::string("x")); }), expected);
    EXPECT_EQ(message([&] { require_writable(path(name)); }), expected);
    // Also when another library has already written the temporary file.
    if (name != "full") {
      std::ofstream(partial_name(path(name))) << "x";
      EXPECT_EQ(message([&] { commit_file(path(name)); }), expected);
      EXPECT_FALSE(fs::exists(partial_name(path(name))));
    }
  }
  EXPECT_TRUE(fs::is_fifo(path("pipe")));
  EXPECT_TRUE(fs::is_fifo(path("hidden")));
  EXPECT_TRUE(fs::is_directory(path("folder/inside")));
  EXPECT_TRUE(fs::is_symlink(path("full")));
}

TEST_F(File, IsReplacedAtTheTargetOfALinkThatRemains) {
  fs::create_directories(path("there"));
  write_file_atomically(path("there/a"), std::string("old"));
  fs::create_symlink("there/a", path("link"));
  fs::create_symlink("link", path("second"));
  write_file_atomically(path("second"), std::string("new"));
  EXPECT_EQ(text(path("there/a")), "new");
  EXPECT_TRUE(fs::is_symlink(path("link")));
  EXPECT_TRUE(fs::is_symlink(path("second")));
  // A link to a missing target creates the file there.
  fs::create_symlink(path("there/b"), path("ahead"));
  write_file_atomically(path("ahead"), std::string("b"));
  EXPECT_EQ(text(path("there/b")), "b");
  EXPECT_TRUE(fs::is_symlink(path("ahead")));
  fs::create_symlink("round", path("round"));
  EXPECT_EQ(message([&] { write_file_atomically(path("round"), std::string("x")); }),
            "cannot write '" + path("round") + "': Too many levels of symbolic links");
  EXPECT_TRUE(same_file(path("second"), path("there/../there/a")));
  EXPECT_FALSE(same_file(path("there/a"), path("there/b")));
  EXPECT_FALSE(same_file(path("none"), path("none")));
}

TEST_F(File, IsCommittedFromATemporaryFileOfAnotherLibrary) {
  std::ofstream(partial_name(path("a"))) << "written by a library";
  commit_file(path("a"));
  EXPECT_EQ(text(path("a")), "written by a library");
  EXPECT_NE(message([&] { commit_file(path("a")); }).find("cannot open"), std::string::npos);
}

}  // namespace
}  // namespace navvy
