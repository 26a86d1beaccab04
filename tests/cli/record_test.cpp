// SPDX-License-Identifier: Apache-2.0
// What a scene records while it runs, what it publishes, and how far it is from its design.
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "folder.h"
#include "process.h"
#include "text_of.h"

namespace navvy {
namespace {

using nlohmann::json;
using test::text_of;

/// A machine that waits for 0.3 s beside a pit that nobody digs: 2 m x 2 m x 0.5 m.
std::string scene(const std::string& records) {
  return R"(<sdf version="1.9" xmlns:navvy="navvy"><world name="w"><navvy:soil ref="loam"/>
<navvy:ground><size_m>6 4</size_m><depth_m>1</depth_m></navvy:ground>
<navvy:solver><cell_m>0.2</cell_m><max_particles>20000</max_particles></navvy:solver>
<navvy:design><area><polygon_m>-1 -1 1 -1 1 1 -1 1</polygon_m><depth_m>0.5</depth_m></area></navvy:design>
<navvy:recording><duration_s>0.4</duration_s><render>false</render></navvy:recording>
)" + records +
         R"(<model name="m"><static>true</static><link name="a"/><link name="b"><pose>0 0 1 0 0 0</pose>
<inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial></link>
<joint name="j" type="revolute"><parent>a</parent><child>b</child><axis><xyz>0 1 0</xyz></axis></joint>
<navvy:program><wait><duration_s>0.3</duration_s></wait></navvy:program></model></world></sdf>)";
}

class Record : public testing::Test {
 protected:
  int navvy(std::vector<std::string> arguments, const std::string& records) {
    std::ofstream(folder_ / "s.sdf") << scene(records);
    arguments.insert(arguments.begin() + 1, folder_ / "s.sdf");
    return test::wait_for(
        test::start({NAVVY_PROGRAM, arguments, {}, "/dev/null", folder_ / "stdout", folder_ / "stderr"}));
  }
  bool has(const std::string& file) const { return std::filesystem::file_size(folder_ / file) > 0; }
  const test::Folder folder_;
};

TEST_F(Record, WritesMapsAndBagsAtTheirRatesAndListsThem) {
  const int status = navvy({"run", "--out", folder_ / "out", "--publish", folder_ / "patches", "--publish-rate", "10"},
                           R"(<navvy:record name="run"><format>bag</format><rate_hz>10</rate_hz></navvy:record>
<navvy:record name="all"><format>mcap</format><layers>elevation cut_fill slope</layers><rate_hz>5</rate_hz></navvy:record>
<navvy:record name="grid"><format>nav2</format><rate_hz>5</rate_hz></navvy:record>
<navvy:record name="set"><format>npz</format><layers>target cut_fill</layers><rate_hz>5</rate_hz></navvy:record>
<navvy:record name="dig"><format>terra</format><rate_hz>5</rate_hz></navvy:record>
)");
  ASSERT_EQ(status, 0) << text_of(folder_ / "stderr");
  const std::string list = text_of(folder_ / "out/navvy.run");
  for (const std::string file : {"run/run_0.db3", "run/metadata.yaml", "all.mcap", "maps/grid_00000.yaml",
                                 "maps/grid_00000.pgm", "maps/grid_00001.yaml", "maps/set_00001.npz",
                                 "maps/dig_00001/images/img_1.npy", "maps/dig_00001/distance/img_1.npy"}) {
    EXPECT_TRUE(has("out/" + file)) << file;
    EXPECT_NE(list.find(file), std::string::npos) << file << " in: " << list;
  }
  // Both ends of an MCAP file are its magic; a bag counts what it holds: clock, tf, odometry, joints, three maps.
  const std::string mcap = text_of(folder_ / "out/all.mcap");
  ASSERT_GT(mcap.size(), 16u);
  EXPECT_EQ(mcap.substr(0, 8), mcap.substr(mcap.size() - 8));
  const std::string metadata = text_of(folder_ / "out/run/metadata.yaml");
  for (const char* topic : {"/clock", "/tf", "/m/odom", "/m/joint_states", "/terrain/grid_map", "/terrain/occupancy"})
    EXPECT_NE(metadata.find(topic), std::string::npos) << topic;
  EXPECT_EQ(text_of(folder_ / "patches/patch_000000001.navvymap").substr(0, 8), "NAVVYMAP");
  // The pit's 2 m x 2 m x 0.5 m are all still there, in columns of 0.2 m: 10 x 10 of them.
  const json design = json::parse(text_of(folder_ / "out/summary.json")).at("design");
  EXPECT_NEAR(design.at("area_m2").get<double>(), 4, 1e-9);
  EXPECT_NEAR(design.at("design_cut_m3").get<double>(), 2, 1e-5);
  EXPECT_NEAR(design.at("under_dig_m3").get<double>(), 2, 1e-5);
  EXPECT_EQ(design.at("over_dig_m3"), 0);
  EXPECT_NEAR(design.at("mean_error_m").get<double>(), 0.5, 1e-5);
  EXPECT_NEAR(design.at("largest_error_m").get<double>(), 0.5, 1e-5);
}

TEST_F(Record, OfAnUnknownFormatOrLayerIsToldWithItsLineBeforeTheRun) {
  const std::string records = R"(<navvy:record name="a"><format>npzz</format></navvy:record>
<navvy:record name="b"><format>npz</format><layers>slop</layers></navvy:record>
)";
  EXPECT_EQ(navvy({"check"}, records), 2);
  const std::string said = text_of(folder_ / "stdout");
  for (const char* part : {"s.sdf:6", "'npzz'", "npz", "s.sdf:7", "'slop'", "slope"})
    EXPECT_NE(said.find(part), std::string::npos) << part << " in: " << said;
  EXPECT_EQ(navvy({"run", "--out", folder_ / "out"}, records), 2);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
}

}  // namespace
}  // namespace navvy
