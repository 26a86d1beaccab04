// SPDX-License-Identifier: Apache-2.0
// A scene resolved into one text reads as the same scene.
#include "scene_io/resolved.h"
#include "control/step_kinds.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "core/file.h"
#include "folder.h"
#include "paths.h"
#include "scene/parameters.h"
#include "scene/soil_values.h"
#include "scene_io/loader.h"
#include "scene_io/world_reader.h"

namespace navvy::scene_io {
namespace {

const std::string kShipped = navvy::source_dir() + "/scenarios";
/// This folder contains no files: the text must not depend on its own place.
const std::string kElsewhere = "/no_such_folder/scene.sdf";

void expect_equal(const scene::Machine& a, const scene::Machine& b) {
  EXPECT_EQ(a.kinematic, b.kinematic);
  EXPECT_EQ(a.fixed_base, b.fixed_base);
  ASSERT_EQ(a.links.size(), b.links.size());
  for (std::size_t i = 0; i < a.links.size(); ++i) {
    EXPECT_EQ(a.links[i].name, b.links[i].name);
    EXPECT_EQ(a.links[i].X_ML.matrix(), b.links[i].X_ML.matrix());
    EXPECT_EQ(a.links[i].mass, b.links[i].mass);
    EXPECT_EQ(a.links[i].inertia, b.links[i].inertia);
    ASSERT_EQ(a.links[i].visuals.size(), b.links[i].visuals.size());
    for (std::size_t v = 0; v < a.links[i].visuals.size(); ++v)
      EXPECT_EQ(a.links[i].visuals[v].geometry.mesh_file, b.links[i].visuals[v].geometry.mesh_file);
  }
  ASSERT_EQ(a.joints.size(), b.joints.size());
  for (std::size_t i = 0; i < a.joints.size(); ++i)
    EXPECT_EQ(a.joints[i].initial, b.joints[i].initial);
  ASSERT_EQ(a.shells.size(), b.shells.size());
  for (std::size_t i = 0; i < a.shells.size(); ++i)
    EXPECT_EQ(a.shells[i].vertices, b.shells[i].vertices);
  EXPECT_EQ(a.cylinders.size(), b.cylinders.size());
  EXPECT_EQ(a.wheels.size(), b.wheels.size());
  EXPECT_EQ(a.beds.size(), b.beds.size());
  EXPECT_EQ(a.has_pump, b.has_pump);
}

void expect_equal(const scene::Scene& a, const scene::Scene& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.seed, b.seed);
  EXPECT_EQ(a.solver.cell, b.solver.cell);
  ASSERT_EQ(a.soils.size(), b.soils.size());
  for (std::size_t i = 0; i < a.soils.size(); ++i) {
    EXPECT_EQ(a.soils[i].name, b.soils[i].name);
    EXPECT_EQ(a.soils[i].source, b.soils[i].source);
    for (int c = 0; c < 3; ++c) EXPECT_EQ(a.soils[i].color[c], b.soils[i].color[c]);
    scene::Soil left = a.soils[i], right = b.soils[i];
    const auto of_left = scene::soil_values(left), of_right = scene::soil_values(right);
    for (std::size_t v = 0; v < of_left.size(); ++v)
      EXPECT_EQ(*of_left[v].value, *of_right[v].value) << left.name << " " << of_left[v].name;
  }
  EXPECT_EQ(a.ground.size, b.ground.size);
  EXPECT_EQ(a.ground.origin, b.ground.origin);
  EXPECT_EQ(a.ground.layers.size(), b.ground.layers.size());
  EXPECT_EQ(a.ground.features.size(), b.ground.features.size());
  ASSERT_EQ(a.machines.size(), b.machines.size());
  for (std::size_t i = 0; i < a.machines.size(); ++i) {
    EXPECT_EQ(a.machines[i].name, b.machines[i].name);
    EXPECT_EQ(a.machines[i].X_WM.matrix(), b.machines[i].X_WM.matrix());
    EXPECT_EQ(a.machines[i].on_ground, b.machines[i].on_ground);
    EXPECT_EQ(a.machines[i].load.mass, b.machines[i].load.mass);
    EXPECT_EQ(a.machines[i].program.steps.size(), b.machines[i].program.steps.size());
    expect_equal(a.machines[i].machine, b.machines[i].machine);
  }
  EXPECT_EQ(a.cameras.size(), b.cameras.size());
  EXPECT_EQ(a.lights.size(), b.lights.size());
  EXPECT_EQ(a.recording.duration, b.recording.duration);
  EXPECT_EQ(a.recording.render, b.recording.render);
}

Overrides with(const std::vector<std::string>& settings) {
  Overrides overrides;
  for (const std::string& setting : settings) overrides.set.push_back(parse_setting(setting));
  return overrides;
}

TEST(Resolved, TextOfEveryShippedSceneReadsAsTheSameScene) {
  int scenes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kShipped)) {
    if (entry.path().extension() != ".sdf") continue;
    SCOPED_TRACE(entry.path());
    std::string text, again;
    const scene::Scene world = load_scene(entry.path().string(), control::step_kinds(), {}, &text);
    const scene::Scene resolved =
        load_scene_from_string(text, kElsewhere, control::step_kinds(), {}, &again);
    expect_equal(world, resolved);
    EXPECT_EQ(text, again) << "resolving it again gives the same text";
    EXPECT_EQ(text.find("<include>"), std::string::npos);
    EXPECT_EQ(text.find(" ref=\""), std::string::npos);
    EXPECT_EQ(text.find(navvy::source_dir() + "/vehicles"), std::string::npos)
        << "shipped files are referenced by model://";
    ++scenes;
  }
  EXPECT_GT(scenes, 5);
}

TEST(Resolved, TextHoldsEveryOverride) {
  Overrides overrides =
      with({"soil.cohesion_pa=3000", "solver.cell_m=0.2", "machine[excavator].x_m=-8.5",
            "machine[excavator].program.dig.depth_m=0.6", "soil.friction_angle_deg.triaxial=31"});
  overrides.seed = 77;
  overrides.duration = 12.5;
  overrides.render = false;
  overrides.size = Vec2(26, 22);
  std::string text;
  const scene::Scene world =
      load_scene(kShipped + "/trench.sdf", control::step_kinds(), overrides, &text);
  const scene::Scene resolved = load_scene_from_string(text, kElsewhere, control::step_kinds());
  expect_equal(world, resolved);
  EXPECT_EQ(resolved.seed, 77u);
  EXPECT_EQ(resolved.recording.duration, 12.5);
  EXPECT_EQ(resolved.soils[0].cohesion, 3000);
  EXPECT_EQ(resolved.soils[0].friction_test, scene::FrictionTest::kTriaxial);
  // Not stated: it followed the cohesion.
  EXPECT_EQ(resolved.soils[0].residual_cohesion, world.soils[0].residual_cohesion);
  EXPECT_EQ(resolved.machines[0].X_WM.translation().x(), -8.5);
}

TEST(Resolved, IncludesTheTableOfMaterials) {
  const std::string file = "<file>materials.sdf</file>",
                    own =
                        "<ground>earth</ground><pair materials=\"ice earth\"><static_friction>0.1"
                        "</static_friction></pair>";
  // The pairs of the file come first, wherever its element stands.
  for (const std::string& table : {file + own, own + file}) {
    const std::string scene = R"(<sdf version="1.9" xmlns:navvy="navvy"><world name="w">
<navvy:soil ref="loam"/><navvy:ground/><navvy:materials>)" +
                              table + "</navvy:materials></world></sdf>";
    Faults faults;
    const auto document = Document::parse(scene, "here/scene.sdf", faults);
    ASSERT_TRUE(document);
    const scene::Scene first = read_world(*document, control::step_kinds(), faults);
    const std::string text = resolved_text(*document, first);
    EXPECT_EQ(text.find("<file>materials.sdf"), std::string::npos);
    const scene::Scene again = load_scene_from_string(text, kElsewhere, control::step_kinds());
    EXPECT_EQ(scene::parameters(again), scene::parameters(first));
    EXPECT_EQ(again.materials.pairs.size(), first.materials.pairs.size());
    EXPECT_GT(again.materials.pairs.size(), 5u);
  }
}

TEST(Resolved, NamesAMapOfTheCommandLineIndependentlyOfItsPlace) {
  const test::Folder folder;
  write_file_atomically(folder / "map.asc", std::string("not read before the ground is laid"));
  Overrides overrides;
  overrides.terrain = std::filesystem::relative(folder / "map.asc").string();
  std::string text;
  const scene::Scene world =
      load_scene(kShipped + "/trench.sdf", control::step_kinds(), overrides, &text);
  const scene::Scene resolved = load_scene_from_string(text, kElsewhere, control::step_kinds());
  EXPECT_TRUE(std::filesystem::equivalent(world.ground.file, resolved.ground.file));
  EXPECT_TRUE(std::filesystem::path(resolved.ground.file).is_absolute());
}

TEST(Resolved, AFileThatChangedSinceIsReported) {
  const test::Folder folder;
  std::filesystem::copy(navvy::source_dir() + "/vehicles/test_bucket", folder.path() / "mine",
                        std::filesystem::copy_options::recursive);
  std::string text;
  load_scene_from_string(
      R"(<sdf version="1.9" xmlns:navvy="navvy"><world name="w"><navvy:soil ref="loam"/>
      <navvy:ground><size_m>8 8</size_m></navvy:ground>
      <include><uri>mine</uri><navvy:on_ground>false</navvy:on_ground></include></world></sdf>)",
      folder / "scene.sdf", control::step_kinds(), {}, &text);
  write_file_atomically(folder / "resolved.sdf", text);
  EXPECT_TRUE(check(folder / "resolved.sdf", control::step_kinds()).empty());
  const std::vector<char> mesh = read_file(folder / "mine/meshes/bucket.obj");
  write_file_atomically(folder / "mine/meshes/bucket.obj",
                        std::string(mesh.begin(), mesh.end()) + "# more\n");
  const std::vector<Fault> faults = check(folder / "resolved.sdf", control::step_kinds());
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(faults[0].severity, Fault::Severity::kWarning);
  EXPECT_NE(faults[0].text().find("bucket.obj"), std::string::npos) << faults[0].text();
}

TEST(Resolved, AFormatOfALaterVersionIsRefused) {
  const std::string text =
      R"(<sdf version="1.9" xmlns:navvy="navvy"><world name="w"><navvy:soil ref="loam"/>
      <navvy:ground><size_m>8 8</size_m></navvy:ground><navvy:resolved format="2"/></world></sdf>)";
  try {
    load_scene_from_string(text, kElsewhere, control::step_kinds());
    FAIL() << "a later format was accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("reads format 1"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace navvy::scene_io
