// SPDX-License-Identifier: Apache-2.0
// `navvy map` from outside: of a scene, a run's folder and a snapshot, and what it says to slips.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "cli/program_run.h"

namespace navvy {
namespace {

class Map : public test::ProgramRun {
 protected:
  void SetUp() override {
    ProgramRun::SetUp();
    // A block of sand that slumps at once, on 48 x 32 columns.
    scene_ = (directory_ / "scene.sdf").string();
    std::ofstream(scene_) << R"(<sdf version="1.9" xmlns:navvy="navvy"><world name="slump"><navvy:soil ref="sand_dry"/>
<navvy:ground><size_m>4.8 3.2</size_m>
<block><center_m>1 0.5</center_m><length_m>0.8</length_m><width_m>0.8</width_m><height_m>0.6</height_m></block>
<awake><min_m>0.6 0.1</min_m><max_m>1.4 0.9</max_m><bottom_m>0</bottom_m></awake></navvy:ground></world></sdf>
)";
  }
  void expect_complained(const std::string& part) const {
    EXPECT_NE(complained().find(part), std::string::npos) << "'" << part << "' is not in:\n" << complained();
  }
  std::string path(const std::string& name) const { return (directory_ / name).string(); }

  /// The floats of a layer in an NPZ, found by its name: entries are stored as they are.
  std::vector<float> layer(const std::string& npz, const std::string& name) const {
    const std::string all = test_text(npz);
    const std::size_t entry = all.find(name + ".npy"), data = all.find('\n', entry);
    if (entry == std::string::npos || data == std::string::npos) return {};
    std::vector<float> out(48 * 32);
    if (data + 1 + out.size() * sizeof(float) > all.size()) return {};
    std::memcpy(out.data(), all.data() + data + 1, out.size() * sizeof(float));
    return out;
  }
  static std::string test_text(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  std::string scene_;
};

TEST_F(Map, OfASceneIsItsUntouchedSite) {
  ASSERT_EQ(run({"map", scene_, "--format", "npz", "--out", path("a.npz")}), 0) << complained();
  const std::vector<float> z = layer(path("a.npz"), "elevation"), slope = layer(path("a.npz"), "slope");
  ASSERT_EQ(z.size(), 48u * 32u);
  EXPECT_NEAR(z[20 * 48 + 34], 0.6, 1e-6);  // the block: x = 1.05, y = 0.45
  EXPECT_NEAR(z[10 * 48 + 34], 0, 1e-6);
  EXPECT_EQ(slope[5 * 48 + 5], 0.0f);
  EXPECT_NE(said().find("48 x 32 columns of 0.1 m"), std::string::npos) << said();
}

TEST_F(Map, OfARunIsItsGroundAtTheEndAndOfASnapshotItsAwakeSoilToo) {
  ASSERT_EQ(run({"run", scene_, "--no-render", "--duration", "0.2", "--snapshot", path("half.snapshot"),
                 "--snapshot-at", "0.1", "--out", out()}),
            0)
      << complained();
  ASSERT_EQ(run({"map", out(), "--format", "npz", "--out", path("end.npz")}), 0) << complained();
  ASSERT_EQ(run({"map", out(), "--start", "--format", "npz", "--out", path("start.npz")}), 0) << complained();
  ASSERT_EQ(run({"map", path("half.snapshot"), "--scene", scene_, "--format", "npz", "--out", path("half.npz")}), 0)
      << complained();
  const std::vector<float> start = layer(path("start.npz"), "elevation"), end = layer(path("end.npz"), "elevation"),
                           before = layer(path("end.npz"), "elevation_start"),
                           half = layer(path("half.npz"), "elevation"), loose = layer(path("half.npz"), "loose_depth"),
                           density = layer(path("half.npz"), "density");
  ASSERT_EQ(half.size(), start.size());
  // Every column as the run's own file has it, which a test of GDAL's reads elsewhere: row 0 is the north.
  ASSERT_EQ(run({"map", out(), "--format", "geotiff", "--layers", "elevation", "--out", path("end.tif")}), 0);
  for (const char* tool : {"gdal_translate"})
    if (std::system((std::string("command -v ") + tool + " >/dev/null 2>&1").c_str()) == 0) {
      const auto raw = [&](const std::string& from, const std::string& to) {
        const std::string command = std::string(tool) + " -q -b 1 -of ENVI '" + from + "' '" + path(to) + "'";
        return std::system(command.c_str()) == 0 ? test_text(path(to)) : std::string();
      };
      const std::string theirs = raw(out() + "/terrain_end.tif", "theirs"), ours = raw(path("end.tif"), "ours");
      ASSERT_EQ(theirs.size(), 48u * 32u * sizeof(float));
      EXPECT_EQ(ours, theirs) << "to the bit: files of a run count in W here";
    }
  double changed = 0, lying = 0, volume = 0;
  for (std::size_t i = 0; i < start.size(); ++i) {
    ASSERT_EQ(before[i], start[i]);
    changed += static_cast<double>(std::abs(end[i] - start[i]));
    lying += static_cast<double>(loose[i]);
    volume += static_cast<double>(half[i]);
    ASSERT_GT(density[i], 0);
  }
  EXPECT_GT(changed, 0.1) << "the block has not moved";
  // 0.8 x 0.8 x 0.6 m of sand are 38.4 columns' worth of a metre, above ground at 0. They lie there still, on ground
  // that woke with them; a tenth for what is in the air and what has loosened. Columns alone would show a pit.
  EXPECT_NEAR(volume, 38.4, 3.84);
  EXPECT_GT(lying, 0.9 * 38.4);
  EXPECT_LT(volume - lying, 0);
  // What a run's files cannot tell is unknown.
  for (const char* name : {"density", "soil", "loose_depth", "awake", "disturbed_at"})
    EXPECT_TRUE(std::isnan(layer(path("end.npz"), name).at(7))) << name;
  // Beside the run's scene a snapshot needs no --scene.
  std::filesystem::copy_file(path("half.snapshot"), out() + "/half.snapshot");
  EXPECT_EQ(run({"map", out() + "/half.snapshot", "--format", "npz", "--out", path("again.npz")}), 0) << complained();
  EXPECT_EQ(test_text(path("again.npz")), test_text(path("half.npz")));
}

TEST_F(Map, AsksWhatWasMeantAndWritesNothingThen) {
  const std::string to = path("none.tif");
  EXPECT_EQ(run({"map", scene_, "--layers", "elevation,slop", "--format", "geotiff", "--out", to}), 2);
  expect_complained("did you mean 'slope'?");
  EXPECT_EQ(run({"map", scene_, "--format", "geotif", "--out", to}), 2);
  expect_complained("did you mean 'geotiff'?");
  EXPECT_EQ(run({"map", "trnch", "--format", "geotiff", "--out", to}), 2);
  expect_complained("did you mean 'trench'?");
  EXPECT_EQ(run({"map", scene_, "--slope-limit-deg", "95", "--format", "nav2", "--out", to}), 2);
  expect_complained("traversability slope");
  EXPECT_EQ(run({"map", scene_, "--format", "geotiff", "--out", path("no/such/folder/a.tif")}), 4);
  std::filesystem::create_directories(path("empty"));
  EXPECT_EQ(run({"map", path("empty"), "--format", "geotiff", "--out", to}), 2);
  expect_complained("no scene.sdf");
  EXPECT_FALSE(std::filesystem::exists(to));
}

TEST_F(Map, TellsLayersAndFormatsInItsHelp) {
  EXPECT_EQ(run({"map", "--help"}), 0);
  for (const char* part : {"traversability", "nav2-scale", "--slope-limit-deg", "Examples: navvy map"})
    EXPECT_NE(said().find(part), std::string::npos) << part << "\n" << said();
}

}  // namespace
}  // namespace navvy
