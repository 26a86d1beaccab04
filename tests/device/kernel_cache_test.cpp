// SPDX-License-Identifier: Apache-2.0
#include "device/kernel_cache.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/log.h"
#include "device/device.h"
#include "device/kernel_program.h"
#include "device/slow_call.h"
#include "folder.h"
#include "process.h"
#include "text_of.h"

namespace navvy::device {
namespace {

namespace fs = std::filesystem;

void write(const fs::path& path, const std::string& text) {
  fs::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << text;
}

using test::text_of;

/// Creates two compiled programs in PoCL's layout, listed by a cache that has been destroyed.
void fill(const fs::path& folder) {
  const KernelCache cache(folder);
  for (const char* program : {"AB/one", "CD/two"}) {
    write(folder / program / "program.bc", "bitcode");
    write(folder / program / "add/1-1-1/add.so", "machine code");
    write(folder / program / "last_accessed", "now");
  }
}

TEST(KernelCache, KeepsUnchangedPrograms) {
  const test::Folder folder;
  fill(folder.path());
  // The driver's own stamp does not count as damage.
  write(folder.path() / "AB/one/last_accessed", "later");
  const KernelCache cache(folder.path());
  EXPECT_EQ(cache.whole(), 4u);
  EXPECT_EQ(cache.removed(), 0u);
}

TEST(KernelCache, RemovesTheWholeProgramOfAFileThatChanged) {
  for (const char* change : {"machine", "Machine code", "machine code and more", ""}) {
    const test::Folder folder;
    fill(folder.path());
    write(folder.path() / "AB/one/add/1-1-1/add.so", change);
    const KernelCache cache(folder.path());
    EXPECT_EQ(cache.removed(), 2u) << change;
    EXPECT_FALSE(fs::exists(folder.path() / "AB/one")) << change;
    EXPECT_TRUE(fs::exists(folder.path() / "CD/two/add/1-1-1/add.so")) << change;
  }
}

TEST(KernelCache, RemovesAProgramThatLostAFile) {
  const test::Folder folder;
  fill(folder.path());
  fs::remove(folder.path() / "CD/two/program.bc");
  const KernelCache cache(folder.path());
  EXPECT_EQ(cache.whole(), 2u);
  EXPECT_FALSE(fs::exists(folder.path() / "CD/two"));
}

TEST(KernelCache, RemovesFilesOfAKilledProcessOnlyWhenAlone) {
  const test::Folder folder;
  fill(folder.path());
  {
    const KernelCache neighbour(folder.path());
    write(folder.path() / "EF/three/program.bc", "of the neighbour");
    const KernelCache cache(folder.path());
    EXPECT_EQ(cache.removed(), 0u) << "a neighbour may have compiled it just now";
  }
  write(folder.path() / "GH/four/program.bc", "nobody's");
  write(folder.path() / "tempfile_a1b2", "half");
  const KernelCache cache(folder.path());
  EXPECT_EQ(cache.whole(), 5u) << "two programs of two files, and the neighbour's";
  EXPECT_EQ(cache.removed(), 1u)
      << "a temporary file is no damage: the driver leaves one in every run";
  EXPECT_FALSE(fs::exists(folder.path() / "GH/four"));
  EXPECT_FALSE(fs::exists(folder.path() / "tempfile_a1b2"));
}

TEST(KernelCache, KeepsAProgramThatANeighbourRecompiles) {
  const test::Folder folder;
  fill(folder.path());
  const fs::path code = folder.path() / "AB/one/add/1-1-1/add.so";
  write(code, "cut");
  const KernelCache first(folder.path());
  EXPECT_EQ(first.removed(), 2u);
  // A neighbour recompiles and has not finished when the next process starts.
  write(code, "machine co");
  const KernelCache second(folder.path());
  EXPECT_EQ(second.removed(), 0u);
  EXPECT_TRUE(fs::exists(code));
}

// PoCL's bitcode names its temporary source file, so two processes never write equal bytes.
TEST(KernelCache, TwoProcessesThatCompileOneProgramLeaveItIntact) {
  const test::Folder folder;
  const fs::path code = folder.path() / "AB/one/program.bc";
  {
    KernelCache first(folder.path());
    const KernelCache second(folder.path());  // lists the files when it is destroyed
    write(code, "compiled by the first");
    first.seal();
    write(code, "compiled by the second");
  }
  const KernelCache cache(folder.path());
  EXPECT_EQ(cache.removed(), 0u);
  EXPECT_EQ(text_of(code), "compiled by the second");
}

TEST(KernelCache, RemovesNothingWhileTwoProcessesCompile) {
  const test::Folder folder;
  const fs::path code = folder.path() / "AB/one/program.bc";
  KernelCache first(folder.path());
  write(code, "compiled by the first");
  first.seal();
  write(code, "compiled by another");
  fs::last_write_time(
      code, fs::last_write_time(folder.path() / "navvy.manifest") + std::chrono::seconds(1));
  EXPECT_EQ(KernelCache(folder.path()).removed(), 0u);
  EXPECT_TRUE(fs::exists(code));
}

TEST(KernelCache, ADamagedListOnlyCausesRecompilation) {
  const test::Folder folder;
  fill(folder.path());
  const fs::path manifest = folder.path() / "navvy.manifest";
  const std::string whole = text_of(manifest);
  for (const std::string& text : {std::string(), std::string("another layout\n"),
                                  whole.substr(0, whole.size() / 2), std::string(1000, '\xff')}) {
    fill(folder.path());
    write(manifest, text);
    EXPECT_NO_THROW(KernelCache{folder.path()}) << text;
  }
}

/// Returns the number of open file descriptors of this process.
rlim_t open_files() {
  rlim_t count = 0;
  for (const auto& file : fs::directory_iterator("/proc/self/fd")) count += file.exists() ? 1 : 0;
  return count;
}

TEST(KernelCache, RemovesNothingWhenItRunsOutOfFileDescriptors) {
  const test::Folder folder;
  fill(folder.path());
  const std::string manifest = text_of(folder.path() / "navvy.manifest");
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &before), 0);
  int refused = 0;
  // From none to enough: every call that opens a file fails once as the first.
  for (rlim_t spare = 0; spare < 12; ++spare) {
    rlimit few = before;
    few.rlim_cur = open_files() + spare;
    ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &few), 0);
    try {
      const KernelCache cache(folder.path());
    } catch (const FileError& error) {
      ++refused;
      EXPECT_NE(std::string(error.what()).find("Too many open files"), std::string::npos)
          << error.what();
    }
    ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &before), 0);
    EXPECT_EQ(text_of(folder.path() / "navvy.manifest"), manifest) << spare;
    const KernelCache whole(folder.path());
    EXPECT_EQ(whole.whole(), 4u) << spare;
    EXPECT_EQ(whole.removed(), 0u) << spare;
  }
  EXPECT_GE(refused, 4) << "lock, lock of the list, list and folders";
  EXPECT_LT(refused, 12);
}

TEST(KernelCache, SealsNothingWhenItRunsOutOfFileDescriptors) {
  const test::Folder folder;
  fill(folder.path());
  const std::string manifest = text_of(folder.path() / "navvy.manifest");
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &before), 0);
  KernelCache cache(folder.path());
  for (rlim_t spare = 0; spare < 6; ++spare) {
    rlimit few = before;
    few.rlim_cur = open_files() + spare;
    ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &few), 0);
    cache.seal();
    ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &before), 0);
    EXPECT_EQ(text_of(folder.path() / "navvy.manifest"), manifest) << spare;
  }
}

TEST(KernelCache, RemovesNothingWhenItsListCannotBeRead) {
  const test::Folder folder;
  fill(folder.path());
  // Reading a folder fails with EISDIR, whoever reads it.
  fs::rename(folder.path() / "navvy.manifest", folder.path() / "kept");
  fs::create_directory(folder.path() / "navvy.manifest");
  EXPECT_THROW(KernelCache{folder.path()}, FileError);
  EXPECT_TRUE(fs::exists(folder.path() / "AB/one/program.bc"));
  fs::remove(folder.path() / "navvy.manifest");
  fs::rename(folder.path() / "kept", folder.path() / "navvy.manifest");
  EXPECT_EQ(KernelCache(folder.path()).whole(), 4u);
}

TEST(KernelCache, RemovesNothingWhenAFileMayNotBeRead) {
  if (geteuid() == 0) GTEST_SKIP() << "root may read every file";
  const test::Folder folder;
  fill(folder.path());
  const fs::path code = folder.path() / "AB/one/add/1-1-1/add.so";
  ASSERT_EQ(chmod(code.c_str(), 0), 0);
  EXPECT_THROW(KernelCache{folder.path()}, FileError);
  ASSERT_EQ(chmod(code.c_str(), 0644), 0);
  EXPECT_EQ(KernelCache(folder.path()).whole(), 4u);
}

TEST(KernelCache, RefusesAFolderThatCannotBeCreated) {
  const test::Folder folder;
  write(folder.path() / "file", "in the way");
  EXPECT_THROW(KernelCache{folder.path() / "file" / "cache"}, FileError);
}

std::string environment_path() {
  const char* path = std::getenv("PATH");
  return path == nullptr ? "" : path;
}

/// Runs this program in a new process: one kernel built and run, with its cache below `cache`.
int run_one_kernel(const std::string& cache, const std::string& log,
                   const std::string& path = environment_path()) {
  test::Command command{fs::read_symlink("/proc/self/exe").string(),
                        {"--gtest_filter=Sizes/VectorAdd.*/3:Device.ListsItselfUnderItsIndex"},
                        {{"POCL_CACHE_DIR", cache}, {"PATH", path}},
                        "/dev/null",
                        log,
                        log + ".err"};
  return test::wait_for(test::start(command));
}

TEST(KernelCacheOfTheDriver, TruncatedMachineCodeIsCompiledAgainInsteadOfCrashing) {
  const test::Folder folder;
  const std::string cache = folder / "cache";
  ASSERT_EQ(run_one_kernel(cache, folder / "first"), 0);
  std::vector<fs::path> code;
  for (const auto& entry : fs::recursive_directory_iterator(cache))
    if (entry.path().extension() == ".so") code.push_back(entry.path());
  if (code.empty()) GTEST_SKIP() << "this device stores no machine code in files";
  for (const fs::path& file : code) fs::resize_file(file, fs::file_size(file) / 2);
  EXPECT_EQ(run_one_kernel(cache, folder / "second"), 0);
  for (const fs::path& file : code) write(file, "");
  EXPECT_EQ(run_one_kernel(cache, folder / "third"), 0);
  EXPECT_EQ(run_one_kernel(cache, folder / "fourth"), 0);
}

TEST(KernelCacheOfTheDriver, TheLinkerIsFoundWithoutPath) {
  const test::Folder folder;
  for (const char* path : {"", "/nonexistent"})
    EXPECT_EQ(run_one_kernel(folder / "cache", folder / "log", path), 0)
        << path << text_of(folder / "log.err");
}

TEST(KernelCacheOfTheDriver, AFolderThatCannotBeCreatedIsReplacedByATemporaryOne) {
  const test::Folder folder;
  write(folder.path() / "file", "in the way");
  EXPECT_EQ(run_one_kernel((folder.path() / "file").string(), folder / "log"), 0);
}

TEST(SlowCall, LogsOnlyAfterItsDelay) {
  std::vector<std::string> said;
  set_log_sink([&](LogLevel, const std::string& text) { said.push_back(text); });
  { const SlowCall quick("quick", 1000); }
  {
    const SlowCall slow("slow", 0);
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
  set_log_sink({});
  EXPECT_EQ(said, std::vector<std::string>{"slow"});
}

}  // namespace
}  // namespace navvy::device
