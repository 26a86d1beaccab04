// SPDX-License-Identifier: Apache-2.0
// Results do not depend on inputs outside the run's physics: pictures, and the folder of scene,
// machines and soils.
#include "determinism/hashed_run.h"

namespace navvy::determinism {
namespace {

constexpr const char* kScene = "bucket_path.sdf";

TEST(Surroundings, PicturesDoNotAffectResults) {
  const HashedRun without = hashed_run("without", kScene, {"--duration", "3"}, {});
  const HashedRun with = hashed_run("with", kScene, {"--duration", "3"}, {}, true);
  EXPECT_GT(with.summary.at("frames").get<int>(), 10);
  EXPECT_EQ(without.summary.at("frames").get<int>(), 0);
  EXPECT_EQ(first_difference(without, with), "");
  EXPECT_EQ(without.summary.at("state_hash"), with.summary.at("state_hash"));
  EXPECT_GT(with.summary.at("activated_columns").get<int>(), 0) << "soil was involved";
}

TEST(Surroundings, TheFolderDoesNotAffectResults) {
  namespace fs = std::filesystem;
  const HashedRun here = hashed_run("here", kScene, {"--duration", "2"}, {});
  // A copy of all shipped files, with blanks in its name, and a run started for it.
  const fs::path copy = run_folder("a copy of it all");
  fs::remove_all(copy);
  for (const char* part : {"scenarios", "vehicles", "terrain"})
    fs::create_directories(copy),
        fs::copy(fs::path(source_dir()) / part, copy / part, fs::copy_options::recursive);
  const HashedRun there =
      hashed_run("there", (copy / "scenarios" / kScene).string(), {"--duration", "2"},
                 {{"NAVVY_DATA_DIR", copy.string()}, {"HOME", copy.string()}});
  EXPECT_EQ(first_difference(here, there), "");
  EXPECT_EQ(here.summary.at("state_hash"), there.summary.at("state_hash"));
  // The scene in the results reproduces the run from its new place.
  const HashedRun again = hashed_run("again", (run_folder("here") / "out" / "scene.sdf").string(),
                                     {"--duration", "2"}, {});
  EXPECT_EQ(first_difference(here, again), "");
}

}  // namespace
}  // namespace navvy::determinism
