// SPDX-License-Identifier: Apache-2.0
// The loader refuses every scene of broken_scenes.txt with all the fragments that the table lists
// for it.
#include "scene_io/broken_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "control/step_kinds.h"
#include "folder.h"
#include "paths.h"
#include "scene_io/loader.h"

namespace navvy::scene_io {
namespace {

/// Writes the table's scenes into a folder of the test.
class BrokenScenes : public ::testing::Test {
 protected:
  BrokenScenes()
      : table_(std::filesystem::path(source_dir()) / "tests/scene_io/broken_scenes.txt") {
    table_.write(folder_.path());
  }

  std::vector<Fault> faults_of(const test::BrokenScene& scene) const {
    return check(folder_ / scene.file, control::step_kinds());
  }

  /// Returns the entries that are scenes, without the parts that they include.
  std::vector<test::BrokenScene> scenes() const {
    std::vector<test::BrokenScene> out;
    for (const test::BrokenScene& scene : table_.scenes())
      if (!scene.fragments.empty()) out.push_back(scene);
    return out;
  }

  test::Folder folder_;
  test::BrokenSceneTable table_;
};

TEST_F(BrokenScenes, EachIsRefusedWithFileLineElementValueAndRule) {
  EXPECT_GE(scenes().size(), 195u);
  for (const test::BrokenScene& scene : scenes()) {
    SCOPED_TRACE(scene.file);
    bool refused = false;
    std::string messages;
    for (const Fault& fault : faults_of(scene)) {
      refused = refused || fault.severity == Fault::Severity::kError;
      messages += fault.text() + "\n";
    }
    EXPECT_TRUE(refused);
    EXPECT_NE(messages.find(folder_.path().string()), std::string::npos) << "no file named in:\n"
                                                                         << messages;
    for (const std::string& fragment : scene.fragments)
      EXPECT_NE(messages.find(fragment), std::string::npos)
          << "'" << fragment << "' not found in:\n"
          << messages;
  }
}

TEST_F(BrokenScenes, AnErrorOfAnElementAlwaysHasItsLine) {
  for (const test::BrokenScene& scene : scenes())
    for (const Fault& fault : faults_of(scene))
      if (!fault.element.empty()) {
        EXPECT_GT(fault.line, 0) << fault.text();
      }
}

TEST_F(BrokenScenes, LoadingThrowsAllFaultsAtOnce) {
  try {
    load_scene(folder_ / "many.sdf", control::step_kinds());
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_EQ(error.faults().size(), check(folder_ / "many.sdf", control::step_kinds()).size());
    EXPECT_GE(error.faults().size(), 5u);
  }
}

TEST_F(BrokenScenes, AMissingFileAndADirectoryAreNamed) {
  EXPECT_THROW(load_scene("no/such/scene.sdf", control::step_kinds()), InputError);
  EXPECT_THROW(load_machine("no/such/model.sdf"), InputError);
  EXPECT_THROW(load_soils("no/such/directory"), InputError);
  const auto faults = check(folder_.path().string(), control::step_kinds());
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_NE(faults[0].text().find("directory"), std::string::npos);
}

}  // namespace
}  // namespace navvy::scene_io
