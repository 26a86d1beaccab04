// SPDX-License-Identifier: Apache-2.0
// `navvy map` as a process: of a scene, a run's folder and a snapshot, and its messages on wrong
// arguments.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
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
    // A block of sand that slumps immediately, on 48 x 32 columns.
    scene_ = (directory_ / "scene.sdf").string();
    std::ofstream(scene_)
        << R"(<sdf version="1.9" xmlns:navvy="navvy"><world name="slump"><navvy:soil ref="sand_dry"/>
<navvy:ground><size_m>4.8 3.2</size_m>
<block><center_m>1 0.5</center_m><length_m>0.8</length_m><width_m>0.8</width_m><height_m>0.6</height_m></block>
<active><min_m>0.6 0.1</min_m><max_m>1.4 0.9</max_m><bottom_m>0</bottom_m></active></navvy:ground></world></sdf>
)";
  }

  /// Returns the floats of a layer in an NPZ, found by name: entries are stored uncompressed.
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

TEST_F(Map, OfASceneShowsItsUntouchedSite) {
  ASSERT_EQ(run({"map", scene_, "--format", "npz", "--out", path("a.npz")}), 0) << complained();
  const std::vector<float> z = layer(path("a.npz"), "elevation"),
                           slope = layer(path("a.npz"), "slope");
  ASSERT_EQ(z.size(), 48u * 32u);
  EXPECT_NEAR(z[20 * 48 + 34], 0.6, 1e-6);  // the block: x = 1.05, y = 0.45
  EXPECT_NEAR(z[10 * 48 + 34], 0, 1e-6);
  EXPECT_EQ(slope[5 * 48 + 5], 0.0f);
  EXPECT_NE(said().find("48 x 32 columns of 0.1 m"), std::string::npos) << said();
}

TEST_F(Map, OfASceneHasItsBodiesAsOccupiedCellsOfNav2) {
  // A wall of 0.4 m x 1.6 m on 8 m x 4 m: the columns 48 to 51 of the rows 12 to 27.
  const std::string walled = path("walled.sdf");
  std::ofstream(walled) << R"(<sdf version="1.9" xmlns:navvy="navvy"><world name="walled">
<navvy:soil ref="loam"/><navvy:ground><size_m>8 4</size_m></navvy:ground>
<model name="wall"><static>true</static><pose>1 0 0.5 0 0 0</pose><link name="base">
<collision name="c"><geometry><box><size>0.4 1.6 2</size></box></geometry></collision></link></model>
</world></sdf>
)";
  ASSERT_EQ(run({"map", walled, "--format", "nav2", "--out", path("map.yaml")}), 0) << complained();
  const std::string pgm = test_text(path("map.pgm")), head = "P5\n80 40\n255\n";
  ASSERT_EQ(pgm.size(), head.size() + 80 * 40);
  int wall = 0, near = 0;
  for (int y = 0; y < 40; ++y)
    for (int ix = 0; ix < 80; ++ix) {
      const auto pixel =
          static_cast<unsigned char>(pgm[head.size() + static_cast<std::size_t>(80 * y + ix)]);
      const int iy = 39 - y;
      // A column whose edge the wall just touches may count as occupied.
      const bool inside = ix >= 48 && ix <= 51 && iy >= 12 && iy <= 27;
      const bool at_edge = ix >= 47 && ix <= 52 && iy >= 11 && iy <= 28;
      wall += inside && pixel == 0 ? 1 : 0;
      near += !at_edge && pixel == 254 ? 1 : 0;
    }
  EXPECT_EQ(wall, 4 * 16);
  EXPECT_EQ(near, 80 * 40 - 6 * 18);
}

TEST_F(Map, LeavesMachinesOutIfAsked) {
  const std::string parked = path("parked.sdf");
  std::ofstream(parked) << R"(<sdf version="1.9" xmlns:navvy="navvy"><world name="parked">
<navvy:soil ref="loam"/><navvy:ground><size_m>24 20</size_m></navvy:ground>
<include><uri>model://ew180</uri><name>digger</name></include></world></sdf>
)";
  const auto occupied = [&](const std::vector<std::string>& options) {
    std::vector<std::string> words = {"map", parked, "--format", "nav2", "--out", path("p.yaml")};
    words.insert(words.end(), options.begin(), options.end());
    EXPECT_EQ(run(words), 0) << complained();
    const std::string pgm = test_text(path("p.pgm"));
    return std::count(pgm.begin() + 15, pgm.end(), '\0');
  };
  EXPECT_GT(occupied({}), 500) << "the excavator covers 6 m x 2.5 m of columns of 0.1 m";
  EXPECT_EQ(occupied({"--without-machines"}), 0);
}

TEST_F(Map, OfARunShowsItsFinalGroundAndOfASnapshotAlsoActiveSoil) {
  ASSERT_EQ(run({"run", scene_, "--no-render", "--duration", "0.2", "--snapshot",
                 path("half.snapshot"), "--snapshot-at", "0.1", "--out", out()}),
            0)
      << complained();
  ASSERT_EQ(run({"map", out(), "--format", "npz", "--out", path("end.npz")}), 0) << complained();
  ASSERT_EQ(run({"map", out(), "--start", "--format", "npz", "--out", path("start.npz")}), 0)
      << complained();
  ASSERT_EQ(run({"map", path("half.snapshot"), "--scene", scene_, "--format", "npz", "--out",
                 path("half.npz")}),
            0)
      << complained();
  const std::vector<float> start = layer(path("start.npz"), "elevation"),
                           end = layer(path("end.npz"), "elevation"),
                           before = layer(path("end.npz"), "elevation_start"),
                           half = layer(path("half.npz"), "elevation"),
                           loose = layer(path("half.npz"), "loose_depth"),
                           density = layer(path("half.npz"), "density");
  ASSERT_EQ(half.size(), start.size());
  // Every column equals that in the run's own file, which a GDAL test reads elsewhere; row 0 is the
  // north.
  ASSERT_EQ(
      run({"map", out(), "--format", "geotiff", "--layers", "elevation", "--out", path("end.tif")}),
      0);
  for (const char* tool : {"gdal_translate"})
    if (std::system((std::string("command -v ") + tool + " >/dev/null 2>&1").c_str()) == 0) {
      const auto raw = [&](const std::string& from, const std::string& to) {
        const std::string command =
            std::string(tool) + " -q -b 1 -of ENVI '" + from + "' '" + path(to) + "'";
        return std::system(command.c_str()) == 0 ? test_text(path(to)) : std::string();
      };
      const std::string theirs = raw(out() + "/terrain_end.tif", "theirs"),
                        ours = raw(path("end.tif"), "ours");
      ASSERT_EQ(theirs.size(), 48u * 32u * sizeof(float));
      EXPECT_EQ(ours, theirs) << "bit-identical: files of a run are in W here";
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
  // 0.8 x 0.8 x 0.6 m of sand are 38.4 columns' worth of a metre, above ground at 0. They are still
  // there, on ground that became active with them; the tolerance of a tenth covers soil in the air
  // and loosening. A map of columns alone would show a pit.
  EXPECT_NEAR(volume, 38.4, 3.84);
  EXPECT_GT(lying, 0.9 * 38.4);
  EXPECT_LT(volume - lying, 0);
  // Layers that the files of a run do not contain are unknown and reported.
  for (const char* name : {"density", "soil", "disturbed_at"})
    EXPECT_TRUE(std::isnan(layer(path("end.npz"), name).at(7))) << name;
  EXPECT_EQ(run({"map", out(), "--format", "npz", "--out", path("end.npz")}), 0) << complained();
  EXPECT_NE(said().find("unknown everywhere: target,cut_fill,density,soil,disturbed_at\n"),
            std::string::npos)
      << said();
  EXPECT_EQ(complained(), "");
  // Loose soil at the end equals that of a snapshot at the same time, rounded once.
  ASSERT_EQ(run({"run", scene_, "--no-render", "--duration", "0.2", "--snapshot",
                 path("end.snapshot"), "--snapshot-at", "0.2", "--out", path("again")}),
            0)
      << complained();
  ASSERT_EQ(run({"map", path("end.snapshot"), "--scene", scene_, "--format", "npz", "--out",
                 path("state.npz")}),
            0);
  EXPECT_EQ(layer(path("end.npz"), "loose_depth"), layer(path("state.npz"), "loose_depth"));
  EXPECT_EQ(layer(path("end.npz"), "active"), layer(path("state.npz"), "active"));
  const std::vector<float> last = layer(path("end.npz"), "loose_depth");
  EXPECT_GT(std::count_if(last.begin(), last.end(), [](float depth) { return depth > 0; }), 60);
  // A snapshot next to the run's scene needs no --scene.
  std::filesystem::copy_file(path("half.snapshot"), out() + "/half.snapshot");
  EXPECT_EQ(run({"map", out() + "/half.snapshot", "--format", "npz", "--out", path("again.npz")}),
            0)
      << complained();
  EXPECT_EQ(test_text(path("again.npz")), test_text(path("half.npz")));
}

TEST_F(Map, SuggestsTheNearestNameAndWritesNothing) {
  const std::string to = path("none.tif");
  EXPECT_EQ(run({"map", scene_, "--layers", "elevation,slop", "--format", "geotiff", "--out", to}),
            2);
  expect_complained("did you mean 'slope'?");
  EXPECT_EQ(run({"map", scene_, "--format", "geotif", "--out", to}), 2);
  expect_complained("did you mean 'geotiff'?");
  EXPECT_EQ(run({"map", "trnch", "--format", "geotiff", "--out", to}), 2);
  expect_complained("did you mean 'trench'?");
  EXPECT_EQ(run({"map", scene_, "--slope-limit-deg", "95", "--format", "nav2", "--out", to}), 2);
  expect_complained("traversability slope");
  EXPECT_EQ(run({"map", scene_, "--format", "geotiff", "--out", path("no/such/folder/a.tif")}), 4);
  expect_complained("mkdir -p '" + path("no/such/folder") + "'");
  std::filesystem::create_directories(path("empty"));
  EXPECT_EQ(run({"map", path("empty"), "--format", "geotiff", "--out", to}), 2);
  expect_complained("no scene.sdf");
  EXPECT_FALSE(std::filesystem::exists(to));
}

TEST_F(Map, NeverReplacesItsInputsOrSpecialFiles) {
  // A site from a map, with a design from another map.
  const auto grid = [&](const std::string& name, double z) {
    std::ofstream file(path(name));
    file << "ncols 20\nnrows 16\nxllcorner 0\nyllcorner 0\ncellsize 1\n";
    for (int i = 0; i < 320; ++i) file << z + 0.01 * i << (i % 20 == 19 ? "\n" : " ");
    file.close();
    return test_text(path(name));
  };
  const std::string own = path("own.sdf");
  std::ofstream(own)
      << R"(<sdf version="1.9" xmlns:navvy="navvy"><world name="own"><navvy:soil ref="sand_dry"/>
<navvy:ground><file>ground.asc</file><size_m>4 4</size_m></navvy:ground>
<navvy:design><file>wanted.asc</file></navvy:design></world></sdf>)";
  const std::string ground = grid("ground.asc", 10), wanted = grid("wanted.asc", 9),
                    scene = test_text(own);
  if (run({"map", own, "--format", "npz", "--out", path("a.npz")}) != 0)
    GTEST_SKIP() << complained();
  std::filesystem::create_hard_link(path("ground.asc"), path("same"));
  std::filesystem::create_symlink("own.sdf", path("link"));
  for (const char* to : {"own.sdf", "link", "ground.asc", "same", "wanted.asc", "./own.sdf"}) {
    EXPECT_EQ(run({"map", own, "--format", "geotiff", "--out", path(to)}), 2) << to;
    expect_complained("which it is made from");
  }
  EXPECT_EQ(test_text(own), scene);
  EXPECT_EQ(test_text(path("ground.asc")), ground);
  EXPECT_EQ(test_text(path("wanted.asc")), wanted);
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  EXPECT_EQ(run({"map", own, "--format", "npz", "--out", path("pipe")}), 4);
  expect_complained("it is a pipe");
  EXPECT_TRUE(std::filesystem::is_fifo(path("pipe")));
  std::filesystem::create_symlink("there.npz", path("away.npz"));
  EXPECT_EQ(run({"map", own, "--format", "npz", "--out", path("away.npz")}), 0) << complained();
  EXPECT_EQ(test_text(path("there.npz")), test_text(path("a.npz")));
  EXPECT_TRUE(std::filesystem::is_symlink(path("away.npz")));
  // The check of such a scene reports its design: 16 m2, from 9.x to 10.x, a metre below the
  // ground.
  EXPECT_EQ(run({"check", own}), 0) << said();
  EXPECT_NE(said().find("wanted.asc: 16 m2 of the site"), std::string::npos) << said();
  EXPECT_NE(said().find("16 m3 to cut, 0 m3 to fill"), std::string::npos) << said();
}

TEST_F(Map, WarnsOfLayersWithoutKnownValues) {
  const std::string to = path("a.npz");
  EXPECT_EQ(run({"map", scene_, "--layers", "elevation,target,cut_fill,disturbed_at", "--format",
                 "npz", "--out", to}),
            0);
  expect_complained("warning: --layers: 'target': is unknown in every column");
  expect_complained("'cut_fill'");
  expect_complained("the scene has no design (add a <navvy:design> to the scene)");
  expect_complained("nothing has changed on an untouched site");
  EXPECT_EQ(complained().find("'elevation'"), std::string::npos) << complained();
  EXPECT_EQ(run({"map", scene_, "--layers", "elevation,loose_depth,soil", "--format", "npz",
                 "--out", to}),
            0);
  EXPECT_EQ(complained(), "");
  EXPECT_EQ(run({"map", scene_, "--format", "terra", "--out", path("t")}), 2);
  expect_complained("add a <navvy:design> to the scene");
  EXPECT_FALSE(std::filesystem::exists(path("t")));
}

TEST_F(Map, ReplacesOnlyFoldersThatItWrote) {
  std::string text = test_text(scene_);
  text.insert(text.find("</world>"),
              "<navvy:design><area><polygon_m>-1 -1 0 -1 0 0 -1 0</polygon_m><depth_m>0.5</depth_m>"
              "</area></navvy:design>");
  std::ofstream(scene_) << text;
  for (const char* format : {"terra", "bag"}) {
    const std::string to = path(format);
    EXPECT_EQ(run({"map", scene_, "--format", format, "--out", to}), 0) << complained();
    EXPECT_EQ(run({"map", scene_, "--format", format, "--out", to + "/"}), 0) << complained();
    std::ofstream(to + "/notes.txt") << "mine";
    EXPECT_EQ(run({"map", scene_, "--format", format, "--out", to}), 2);
    expect_complained("'notes.txt'");
    expect_complained("name a new folder");
    EXPECT_EQ(test_text(to + "/notes.txt"), "mine");
  }
}

TEST_F(Map, ListsLayersAndFormatsInItsHelp) {
  EXPECT_EQ(run({"map", "--help"}), 0);
  for (const char* part :
       {"traversability", "nav2-scale", "--slope-limit-deg", "Examples: navvy map"})
    EXPECT_NE(said().find(part), std::string::npos) << part << "\n" << said();
}

}  // namespace
}  // namespace navvy
