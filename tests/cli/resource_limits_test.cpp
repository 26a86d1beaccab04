// SPDX-License-Identifier: Apache-2.0
// The program with few open files, little memory and no further process: what it says is wrong.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "cli/program_run.h"

namespace navvy {
namespace {

class ResourceLimits : public test::ProgramRun {
 protected:
  /// Runs navvy from a shell that first executes `limit`; returns the exit status.
  int run_after(const std::string& limit, const std::vector<std::string>& arguments,
                const std::vector<std::string>& wrapper = {}) {
    std::vector<std::string> words = {"-c", limit + "; exec \"$@\"", "sh"};
    words.insert(words.end(), wrapper.begin(), wrapper.end());
    words.emplace_back(NAVVY_PROGRAM);
    words.insert(words.end(), arguments.begin(), arguments.end());
    return test::wait_for(
        test::start({"/bin/sh", words, environment_, "/dev/null", (directory_ / "stdout").string(),
                     (directory_ / "stderr").string()}));
  }
  std::vector<std::string> short_run() const {
    return {"run", "bucket_path", "--no-render", "--duration", "0.02", "--out", out()};
  }
  bool complains(const std::string& part) const {
    return complained().find(part) != std::string::npos;
  }
};

TEST_F(ResourceLimits, FewOpenFilesAreNamed) {
  int named = 0;
  for (int files = 4; files <= 18; files += 2) {
    const int status = run_after("ulimit -n " + std::to_string(files), short_run());
    // 127: the system could not even load the libraries.
    if (status == 127) continue;
    EXPECT_TRUE(status == 0 || (status >= 2 && status <= 4)) << files << ": " << complained();
    EXPECT_FALSE(complains("apt-get install")) << files << ": " << complained();
    EXPECT_FALSE(complains("internal error")) << files << ": " << complained();
    if (status != 0) EXPECT_TRUE(complains("open files") || complains("ulimit -n")) << complained();
    named += status != 0 ? 1 : 0;
  }
  EXPECT_GE(named, 4);
}

TEST_F(ResourceLimits, LittleMemoryIsNamed) {
  int named = 0;
  for (int kib = 380000; kib <= 500000; kib += 20000) {
    const int status = run_after("ulimit -v " + std::to_string(kib), {"devices"});
    if (status == 127) continue;
    EXPECT_TRUE(status == 0 || status == 3) << kib << ": " << complained();
    EXPECT_FALSE(complains("apt-get install")) << kib << ": " << complained();
    EXPECT_FALSE(complains("internal error")) << kib << ": " << complained();
    named += complains("ulimit -v unlimited") ? 1 : 0;
  }
  EXPECT_GE(named, 1);
}

TEST_F(ResourceLimits, NoFurtherProcessIsNamed) {
  // The limit does not hold for root.
  const bool root = geteuid() == 0;
  std::vector<std::string> wrapper;
  if (root) wrapper = {"setpriv", "--reuid", "65533", "--clear-groups"};
  std::filesystem::permissions(directory_, std::filesystem::perms::all);
  environment_ = {{"POCL_CACHE_DIR", (directory_ / "cache").string()}};
  if (root && run_after("true", {"--version"}, wrapper) != 0)
    GTEST_SKIP() << "another user cannot start the program: " << complained();
  wrapper.insert(wrapper.begin(), {"prlimit", "--nproc=1"});
  const int status = run_after("true", short_run(), wrapper);
  EXPECT_EQ(status, 3) << complained();
  EXPECT_TRUE(complains("ulimit")) << complained();
  EXPECT_FALSE(complains("internal error")) << complained();
}

TEST_F(ResourceLimits, CellsOfTwoCentimetresRunOrNameTheMemoryTheyWant) {
  const std::string path = (directory_ / "fine.sdf").string();
  std::ofstream(path)
      << "<sdf version=\"1.9\" xmlns:navvy=\"navvy\"><world name=\"fine\">\n"
         "<navvy:soil ref=\"sand_dry\"/>\n"
         "<navvy:ground><size_m>4 4</size_m><depth_m>0.5</depth_m><block><center_m>0 0</center_m>"
         "<length_m>0.4</length_m><width_m>0.4</width_m><height_m>0.3</height_m></block>"
         "<active><min_m>-0.3 -0.3</min_m><max_m>0.3 0.3</max_m><bottom_m>-0.1</bottom_m></active>"
         "</navvy:ground>\n"
         "<navvy:solver><cell_m>0.02</cell_m></navvy:solver>\n"
         "<navvy:recording><duration_s>0.03</duration_s></navvy:recording></world></sdf>\n";
  EXPECT_EQ(run({"check", path}), 0) << complained();
  EXPECT_NE(said().find("a cubic metre of active soil takes 1e+06 particles and 206 MiB"),
            std::string::npos)
      << said();
  EXPECT_EQ(run({"run", path, "--no-render", "--out", out()}), 0) << complained();
  EXPECT_GT(summary().at("particles_peak").get<int>(), 70000);
  EXPECT_EQ(summary().at("mass_ledger").at("error_units"), 0);
  environment_ = {{"NAVVY_DEVICE_MEMORY_MIB", "10"}};
  EXPECT_EQ(run({"run", path, "--no-render", "--out", out()}), 3) << complained();
  EXPECT_TRUE(complains("MiB are wanted and the device allows 10.0 MiB")) << complained();
  EXPECT_TRUE(complains("use a larger soil cell")) << complained();
}

}  // namespace
}  // namespace navvy
