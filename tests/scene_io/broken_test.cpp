// SPDX-License-Identifier: Apache-2.0
// Every broken/NAME.sdf must be refused with all the fragments that broken/NAME.txt lists, one per
// line.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "control/step_kinds.h"
#include "core/file.h"
#include "paths.h"
#include "scene_io/loader.h"
#include "text_of.h"

namespace navvy::scene_io {
namespace {

const std::filesystem::path kBroken =
    std::filesystem::path(navvy::source_dir()) / "tests/scene_io/broken";

using test::text_of;

std::vector<std::filesystem::path> broken_files() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(kBroken))
    if (entry.path().extension() == ".sdf") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

std::string messages(const std::vector<Fault>& faults) {
  std::string all;
  for (const Fault& fault : faults) all += fault.text() + "\n";
  return all;
}

TEST(BrokenFiles, EachIsRefusedWithFileLineElementValueAndRule) {
  const auto files = broken_files();
  EXPECT_GE(files.size(), 40u);
  for (const auto& file : files) {
    SCOPED_TRACE(file.filename().string());
    const std::vector<Fault> faults = check(file.string(), control::step_kinds());
    const bool refused = std::any_of(faults.begin(), faults.end(), [](const Fault& f) {
      return f.severity == Fault::Severity::kError;
    });
    EXPECT_TRUE(refused);
    const std::string all = messages(faults);
    EXPECT_NE(all.find(kBroken.string()), std::string::npos) << "no file named in:\n" << all;
    std::istringstream expected(text_of(std::filesystem::path(file).replace_extension(".txt")));
    for (std::string fragment; std::getline(expected, fragment);)
      EXPECT_NE(all.find(fragment), std::string::npos) << "'" << fragment << "' not found in:\n"
                                                       << all;
  }
}

TEST(BrokenFiles, EachNamesAtLeastOneExpectedFragment) {
  for (const auto& file : broken_files()) {
    const auto expected = std::filesystem::path(file).replace_extension(".txt");
    ASSERT_TRUE(std::filesystem::exists(expected)) << expected;
    EXPECT_GT(text_of(expected).size(), 5u) << expected;
  }
}

TEST(BrokenFiles, AnErrorOfAnElementAlwaysKnowsItsLine) {
  for (const auto& file : broken_files())
    for (const Fault& fault : check(file.string(), control::step_kinds()))
      if (!fault.element.empty()) {
        EXPECT_GT(fault.line, 0) << fault.text();
      }
}

TEST(BrokenFiles, LoadingThrowsAllFaultsAtOnce) {
  try {
    load_scene((kBroken / "many.sdf").string(), control::step_kinds());
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_EQ(error.faults().size(),
              check((kBroken / "many.sdf").string(), control::step_kinds()).size());
    EXPECT_GE(error.faults().size(), 5u);
  }
}

TEST(BrokenFiles, AMissingFileAndADirectoryAreNamed) {
  EXPECT_THROW(load_scene("no/such/scene.sdf", control::step_kinds()), InputError);
  EXPECT_THROW(load_machine("no/such/model.sdf"), InputError);
  EXPECT_THROW(load_soils("no/such/directory"), InputError);
  const auto faults = check(kBroken.string(), control::step_kinds());
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_NE(faults[0].text().find("directory"), std::string::npos);
}

}  // namespace
}  // namespace navvy::scene_io
