// SPDX-License-Identifier: Apache-2.0
// Ownership of files in a run's folder: files of a run are moved and removed, all other files stay.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "core/error.h"
#include "core/file.h"
#include "folder.h"
#include "record/crash_summary.h"
#include "record/run_folder.h"
#include "text_of.h"

namespace navvy::record {
namespace {

namespace fs = std::filesystem;

void write(const std::string& path, const std::string& text) {
  fs::create_directories(fs::path(path).parent_path());
  write_file_atomically(path, text);
}
using test::text_of;

/// Simulates a run that leaves three files with its number in them.
void run(const std::string& out, int number) {
  RunFolder folder(out);
  folder.begin();
  for (const char* name : {"summary.json", "telemetry.csv", "frames/left_00001.png"})
    write_file_atomically(folder.path(name), std::to_string(number));
}

/// Returns every path below `folder` and the contents of its files, in order.
std::vector<std::string> everything_in(const fs::path& folder) {
  std::vector<std::string> out;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    out.push_back(entry.path().string() +
                  (entry.is_regular_file() ? ": " + text_of(entry.path()) : "/"));
  std::sort(out.begin(), out.end());
  return out;
}

std::string refusal(const std::string& out, const std::vector<std::string>& reads = {}) {
  try {
    RunFolder folder(out, reads);
    folder.begin();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(RunFolderLock, KeepsOneEarlierRun) {
  const test::Folder folder;
  const std::string out = folder / "out";
  for (int number = 1; number <= 3; ++number) run(out, number);
  EXPECT_EQ(text_of(out + "/summary.json"), "3");
  EXPECT_EQ(text_of(out + ".previous/summary.json"), "2");
  EXPECT_EQ(text_of(out + ".previous/frames/left_00001.png"), "2");
}

TEST(RunFolderLock, MovesNestedFoldersWithTheirFiles) {
  const test::Folder folder;
  const std::string out = folder / "out", deep = "maps/dig_00001/images/img_1.npy";
  {
    RunFolder first(out);
    first.begin();
    write(first.path(deep), "a map");
  }
  run(out, 1);
  EXPECT_FALSE(fs::exists(out + "/maps"));
  EXPECT_EQ(text_of(out + ".previous/" + deep), "a map");
  run(out, 2);
  EXPECT_FALSE(fs::exists(out + ".previous/maps"));
}

TEST(RunFolderLock, UserFilesSurviveAnyNumberOfRuns) {
  const test::Folder folder;
  const std::string out = folder / "out";
  run(out, 1);
  const std::vector<std::string> own = {out + "/notes.txt", out + "/frames/mine.png",
                                        out + "/deep/er/notes.txt"};
  for (const std::string& path : own) write(path, path);
  run(out, 2);
  write(out + ".previous/notes.txt", "beside the earlier run");
  for (int number = 3; number <= 6; ++number) run(out, number);
  for (const std::string& path : own) EXPECT_EQ(text_of(path), path);
  EXPECT_EQ(text_of(out + ".previous/notes.txt"), "beside the earlier run");
  EXPECT_EQ(text_of(out + "/summary.json"), "6");
  EXPECT_EQ(text_of(out + ".previous/summary.json"), "5");
}

TEST(RunFolderLock, RefusesAFolderWithForeignResults) {
  const test::Folder folder;
  const std::string out = folder / "out";
  write(out + "/summary.json", "of another program");
  write(out + "/thesis.tex", "years of work");
  const std::vector<std::string> before = everything_in(folder.path());
  EXPECT_NE(refusal(out).find("'summary.json' that no run wrote"), std::string::npos)
      << refusal(out);
  EXPECT_NE(refusal(out).find("--out"), std::string::npos);
  EXPECT_EQ(everything_in(folder.path()), before);
  // The same if the folder of the earlier run is foreign.
  run(folder / "mine", 1);
  write(folder / "mine.previous/summary.json", "of another program");
  const std::vector<std::string> with_mine = everything_in(folder.path());
  EXPECT_NE(refusal(folder / "mine"), "");
  EXPECT_EQ(everything_in(folder.path()), with_mine);
  // A marker of another program or another version must not be removed.
  write(folder / "other/navvy.run", "something else\n");
  const std::vector<std::string> with_other = everything_in(folder.path());
  EXPECT_NE(refusal(folder / "other"), "");
  EXPECT_EQ(everything_in(folder.path()), with_other);
}

TEST(RunFolderLock, TwoRunsIntoOneFolderAreRefused) {
  const test::Folder folder;
  const std::string out = folder / "out";
  run(out, 1);
  {
    RunFolder first(out);
    first.begin();
    write_file_atomically(first.path("summary.json"), std::string("first"));
    EXPECT_NE(refusal(out).find("another run is writing"), std::string::npos) << refusal(out);
    EXPECT_NE(refusal(out + "/"), "");
    EXPECT_EQ(text_of(out + "/summary.json"), "first");
  }
  EXPECT_EQ(refusal(out), "");
}

TEST(RunFolderLock, InputsOfTheRunAreNotRemoved) {
  const test::Folder folder;
  const std::string out = folder / "out";
  {
    RunFolder failed(out);
    failed.begin();
    for (const char* name : {"summary.json", "failed.snapshot"})
      write_file_atomically(failed.path(name), std::string("1"));
  }
  // Inputs among the present results: they are moved, not removed.
  EXPECT_EQ(refusal(out, {out + "/failed.snapshot"}), "");
  EXPECT_EQ(text_of(out + ".previous/failed.snapshot"), "1");
  // The resumed run has left its own results; once more from the same snapshot.
  run(out, 2);
  const std::string said = refusal(out, {"", out + ".previous/failed.snapshot"});
  EXPECT_NE(said.find("would be removed"), std::string::npos) << said;
  EXPECT_EQ(text_of(out + ".previous/failed.snapshot"), "1");
  EXPECT_EQ(text_of(out + "/summary.json"), "2");
}

TEST(RunFolderLock, ContinuesAnInterruptedMove) {
  const test::Folder folder;
  const std::string out = folder / "out";
  run(out, 1);
  run(out, 2);
  // State after a kill: the list says "moving", one file of three has been moved.
  write(out + ".previous/navvy.run",
        "navvy run folder 1 moving\nframes/left_00001.png\nsummary.json\ntelemetry.csv\n");
  fs::rename(out + "/summary.json", out + ".previous/summary.json");
  fs::remove(out + ".previous/telemetry.csv");
  fs::remove_all(out + ".previous/frames");
  run(out, 3);
  for (const char* name : {"/summary.json", "/telemetry.csv", "/frames/left_00001.png"}) {
    EXPECT_EQ(text_of(out + ".previous" + name), "2") << name;
    EXPECT_EQ(text_of(out + name), "3") << name;
  }
}

TEST(RunFolderLock, ADamagedListAffectsNoOtherFiles) {
  const test::Folder folder;
  const std::string out = folder / "out";
  write(folder / "precious", "mine");
  write(out + ".previous/navvy.run",
        "navvy run folder 1\n../precious\n" + (folder / "precious") + "\n./x\n\nsumm");
  run(out, 1);
  run(out, 2);
  EXPECT_EQ(text_of(folder / "precious"), "mine");
  write(out + ".previous/navvy.run", "something else\n");
  EXPECT_NE(refusal(out).find("navvy.run"), std::string::npos);
}

TEST(RunFolderLock, AFileCreatedMeanwhileIsNotOverwritten) {
  const test::Folder folder;
  RunFolder own(folder / "out");
  own.begin();
  write(folder / "out/frames/left_00007.png", "mine");
  EXPECT_THROW(own.path("frames/left_00007.png"), FileError);
  EXPECT_NO_THROW(own.path("frames/left_00008.png"));
}

TEST(RunFolderLock, RemovesAFolderThatWasNotUsed) {
  const test::Folder folder;
  { const RunFolder unused(folder / "out"); }
  EXPECT_FALSE(fs::exists(folder / "out"));
  // Parent folders that were created for it are removed, too.
  fs::create_directory(folder / "mine");
  { const RunFolder unused(folder / "mine/of/a/run"); }
  EXPECT_TRUE(fs::is_empty(folder / "mine"));
  // In an existing folder only the marker is removed.
  { const RunFolder unused(folder / "mine"); }
  EXPECT_TRUE(fs::is_empty(folder / "mine"));
  // A file created meanwhile stays, with its folder.
  {
    const RunFolder unused(folder / "mine/of/a/run");
    write(folder / "mine/of/notes.txt", "of somebody");
  }
  EXPECT_EQ(text_of(folder / "mine/of/notes.txt"), "of somebody");
  EXPECT_FALSE(fs::exists(folder / "mine/of/a"));
  // Results stay if the next run fails before it begins.
  run(folder / "out", 1);
  const std::vector<std::string> before = everything_in(folder.path());
  { const RunFolder unused(folder / "out"); }
  EXPECT_EQ(everything_in(folder.path()), before);
}

/// Two owners in turn: the present owner holds a marker that the other one sees.
TEST(RunFolderLock, RecreatesAMarkerRemovedByAnotherRun) {
  const test::Folder folder;
  const std::string out = folder / "out";
  fs::create_directory(out);
  std::atomic<int> taken{0}, without_marker{0};
  const auto take = [&] {
    for (int i = 0; i < 2000; ++i) try {
        const RunFolder own(out);
        ++taken;
        without_marker += !fs::exists(out + "/navvy.run");
      } catch (const InputError&) {  // owned by the other one
      }
  };
  std::thread other(take);
  take();
  other.join();
  EXPECT_GT(taken, 0);
  EXPECT_EQ(without_marker, 0) << "of " << taken;
  EXPECT_TRUE(fs::is_empty(out));
}

TEST(CrashSummary, PutStatusAndMessageIntoTheLastSummary) {
  const test::Folder folder;
  CrashSummary words(folder / "reserve", folder / "summary.json");
  EXPECT_GE(fs::file_size(folder / "reserve"), 64u << 10);
  EXPECT_FALSE(write_crash_summary("failed", "no summary was held"))
      << "and it can be read only once";
  CrashSummary again(folder / "reserve2", folder / "summary.json");
  nlohmann::json summary{{"status", "running"}, {"steps", 7}, {"cycles", nlohmann::json::array()}};
  for (int i = 0; i < 5000; ++i)
    summary["cycles"].push_back("a line per cycle: it outgrows the initial allocation");
  again.keep(summary.dump(2));
  summary["steps"] = 8;
  again.keep(summary.dump(2));
  ASSERT_TRUE(write_crash_summary("failed", "a \"quote\", a \\ and\na line"));
  const auto left = nlohmann::json::parse(text_of(folder / "summary.json"));
  EXPECT_EQ(left.at("status"), "failed");
  EXPECT_EQ(left.at("message"), "a 'quote', a   and;a line");
  EXPECT_EQ(left.at("steps"), 8);
  EXPECT_EQ(left.at("cycles").size(), 5000u);
  EXPECT_FALSE(fs::exists(folder / "reserve2"));
}

}  // namespace
}  // namespace navvy::record
