// SPDX-License-Identifier: Apache-2.0
// Every scene of scenarios/ runs to its stated end: exit status 0, all programs done, no mass lost.
// Its cameras show all machines until then.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "control/step_kinds.h"
#include "folder.h"
#include "machine_pictures.h"
#include "paths.h"
#include "process.h"
#include "run/simulation.h"
#include "scene_io/loader.h"
#include "text_of.h"

namespace navvy {
namespace {

namespace fs = std::filesystem;

/// Returns the files of all shipped scenes, relative to scenarios/, in alphabetical order.
std::vector<std::string> shipped_scenes() {
  const fs::path root = fs::path(source_dir()) / "scenarios";
  std::vector<std::string> out;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root))
    if (entry.path().extension() == ".sdf")
      out.push_back(fs::relative(entry.path(), root).generic_string());
  std::sort(out.begin(), out.end());
  return out;
}

class ShippedScene : public testing::TestWithParam<std::string> {};

TEST_P(ShippedScene, RunsToItsStatedEnd) {
  const test::Folder folder;
  test::Command command{NAVVY_PROGRAM,
                        {"run", source_dir() + "/scenarios/" + GetParam(), "--no-render", "--quiet",
                         "--out", folder / "out"},
                        {}};
  command.err = folder / "err";
  EXPECT_EQ(test::wait_for(test::start(command)), 0) << test::text_of(command.err);
  const auto summary = nlohmann::json::parse(test::text_of(folder / "out/summary.json"));
  EXPECT_EQ(summary.at("status"), "finished");
  for (const auto& program : summary.at("programs"))
    EXPECT_EQ(program.at("state"), "done") << program.dump(1);
  EXPECT_EQ(summary.at("mass_ledger").at("error_units"), 0);
}

TEST_P(ShippedScene, ShowsEachMachineToItsEnd) {
  run::Simulation simulation(
      scene_io::load_scene(source_dir() + "/scenarios/" + GetParam(), control::step_kinds()));
  test::MachinePictures pictures(simulation.world());
  const double share = GetParam().rfind("paper/", 0) == 0 ? 0.25 : 0.02;
  pictures.expect_shown(share);
  double next = 1;
  run::LoopHooks hooks;
  hooks.progress = [&](const run::RunProgress& progress) {
    if (progress.time < next || HasFailure()) return;
    next += 1;
    pictures.expect_shown(share);
  };
  simulation.run_to_end(hooks);
}

INSTANTIATE_TEST_SUITE_P(All, ShippedScene, testing::ValuesIn(shipped_scenes()),
                         [](const testing::TestParamInfo<std::string>& test) {
                           std::string name = fs::path(test.param).replace_extension().string();
                           std::replace_if(
                               name.begin(), name.end(),
                               [](unsigned char c) { return !std::isalnum(c); }, '_');
                           return name;
                         });

}  // namespace
}  // namespace navvy
