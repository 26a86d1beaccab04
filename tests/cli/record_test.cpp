// SPDX-License-Identifier: Apache-2.0
// Recordings and publications of a scene during a run, and its deviation from the design.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "folder.h"
#include "process.h"
#include "text_of.h"

namespace navvy {
namespace {

using nlohmann::json;
using test::text_of;

/// A machine that waits for 0.3 s beside a designed pit that nobody digs: 2 m x 2 m x 0.5 m.
std::string scene(const std::string& records, const std::string& active = "") {
  return R"(<sdf version="1.9" xmlns:navvy="navvy"><world name="w"><navvy:soil ref="sand_dry"/>
<navvy:ground><size_m>6 4</size_m><depth_m>1</depth_m>)" +
         active + R"(</navvy:ground>
<navvy:solver><cell_m>0.2</cell_m><max_particles>20000</max_particles></navvy:solver>
<navvy:design><area><polygon_m>-1 -1 1 -1 1 1 -1 1</polygon_m><depth_m>0.5</depth_m></area></navvy:design>
<navvy:recording><duration_s>0.4</duration_s><render>false</render></navvy:recording>
)" + records +
         R"(<model name="m"><static>true</static><link name="a"/><link name="b"><pose>0 0 1 0 0 0</pose>
<inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial></link>
<joint name="j" type="revolute"><parent>a</parent><child>b</child><axis><xyz>0 1 0</xyz></axis></joint>
<navvy:program><wait><duration_s>0.3</duration_s></wait></navvy:program></model></world></sdf>)";
}

/// Returns z of the vertices of a binary PLY, row by row from the least y: the header first, then x
/// y z as doubles.
std::vector<float> heights_of_ply(const std::string& bytes) {
  const std::size_t begin = bytes.find("end_header\n") + 11;
  std::istringstream head(bytes.substr(0, begin));
  std::size_t vertices = 0, size = 0;
  bool of_vertex = false;
  for (std::string line; std::getline(head, line);) {
    std::istringstream words(line);
    std::string first, second;
    words >> first >> second;
    if (first == "element") of_vertex = second == "vertex";
    if (first == "element" && of_vertex) words >> vertices;
    if (first == "property" && of_vertex) size += second == "double" ? 8 : 4;
  }
  std::vector<float> out;
  for (std::size_t i = 0; i < vertices; ++i) {
    double z = 0;
    std::memcpy(&z, bytes.data() + begin + i * size + 16, 8);
    out.push_back(static_cast<float>(z));
  }
  return out;
}

/// Soil that collapses from the start.
const char* const kHeap =
    "<block><center_m>1 1</center_m><length_m>1</length_m><width_m>1</width_m>"
    "<height_m>1</height_m></block><active><min_m>0.4 0.4</min_m><max_m>1.6 1.6</max_m></active>";

class Record : public testing::Test {
 protected:
  int navvy(std::vector<std::string> arguments, const std::string& records,
            const std::string& active = "", const std::string& input = "") {
    std::ofstream(folder_ / "s.sdf") << scene(records, active);
    std::ofstream(folder_ / "in") << input;
    arguments.insert(arguments.begin() + 1, folder_ / "s.sdf");
    return test::wait_for(test::start(
        {NAVVY_PROGRAM, arguments, {}, folder_ / "in", folder_ / "stdout", folder_ / "stderr"}));
  }
  std::string metadata(const std::string& bag) const {
    return text_of(folder_ / "out/" + bag + "/metadata.yaml");
  }
  /// Returns the number of messages of a topic of a bag.
  int messages(const std::string& bag, const std::string& topic) const {
    const std::string text = metadata(bag), key = "message_count: ";
    return std::stoi(text.substr(text.find(key, text.find("name: " + topic + "\n")) + key.size()));
  }
  /// Returns the headers of a folder's patches, and applies their elevation.
  std::vector<json> patches(const std::string& place, std::vector<float>& elevation) const {
    std::vector<json> headers;
    for (int number = 1;; ++number) {
      char name[40];
      std::snprintf(name, sizeof name, "/patch_%09d.navvymap", number);
      if (!std::filesystem::exists(folder_ / place + name)) return headers;
      const std::string bytes = text_of(folder_ / place + name);
      std::uint32_t length = 0;
      std::memcpy(&length, bytes.data() + 8, 4);
      const json head = json::parse(bytes.substr(12, length));
      headers.push_back(head);
      elevation.resize(head.at("nx").get<std::size_t>() * head.at("ny").get<std::size_t>());
      // The only layer.
      std::size_t at = 12 + length;
      for (const json& rect : head.at("rects"))
        for (std::size_t iy = rect[1]; iy < rect[3]; ++iy)
          for (std::size_t ix = rect[0]; ix < rect[2]; ++ix, at += 4)
            std::memcpy(&elevation[iy * head.at("nx").get<std::size_t>() + ix], bytes.data() + at,
                        4);
      EXPECT_EQ(at, bytes.size()) << name;
    }
  }
  /// Returns the elevation at the run's end from its own map, by `navvy map`.
  std::vector<float> elevation_at_the_end() const {
    const std::string points = folder_ / "end.ply";
    EXPECT_EQ(test::wait_for(test::start({NAVVY_PROGRAM,
                                          {"map", folder_ / "out", "--layers", "elevation",
                                           "--format", "ply", "--out", points},
                                          {},
                                          "/dev/null",
                                          folder_ / "map.out",
                                          folder_ / "map.err"})),
              0)
        << text_of(folder_ / "map.err");
    return heights_of_ply(text_of(points));
  }
  bool has(const std::string& file) const { return std::filesystem::file_size(folder_ / file) > 0; }
  const test::Folder folder_;
};

TEST_F(Record, WritesMapsAndBagsAtTheirRatesAndListsThem) {
  const int status = navvy(
      {"run", "--out", folder_ / "out", "--publish", folder_ / "patches", "--publish-rate", "10"},
      R"(<navvy:record name="run"><format>bag</format><rate_hz>10</rate_hz></navvy:record>
<navvy:record name="all"><format>mcap</format><layers>elevation cut_fill slope</layers><rate_hz>5</rate_hz></navvy:record>
<navvy:record name="grid"><format>nav2</format><rate_hz>5</rate_hz></navvy:record>
<navvy:record name="set"><format>npz</format><layers>target cut_fill</layers><rate_hz>5</rate_hz></navvy:record>
<navvy:record name="dig"><format>terra</format><rate_hz>5</rate_hz></navvy:record>
)");
  ASSERT_EQ(status, 0) << text_of(folder_ / "stderr");
  const std::string list = text_of(folder_ / "out/navvy.run");
  for (const std::string file :
       {"run/run_0.db3", "run/metadata.yaml", "all.mcap", "maps/grid_00000.yaml",
        "maps/grid_00000.pgm", "maps/grid_00001.yaml", "maps/set_00001.npz",
        "maps/dig_00001/images/img_1.npy", "maps/dig_00001/distance/img_1.npy"}) {
    EXPECT_TRUE(has("out/" + file)) << file;
    EXPECT_NE(list.find(file), std::string::npos) << file << " in: " << list;
  }
  // An MCAP file begins and ends with its magic; a bag counts its messages: clock, tf, odometry,
  // joints, three maps.
  const std::string mcap = text_of(folder_ / "out/all.mcap");
  ASSERT_GT(mcap.size(), 16u);
  EXPECT_EQ(mcap.substr(0, 8), mcap.substr(mcap.size() - 8));
  const std::string metadata = text_of(folder_ / "out/run/metadata.yaml");
  for (const char* topic :
       {"/clock", "/tf", "/m/odom", "/m/joint_states", "/terrain/grid_map", "/terrain/occupancy"})
    EXPECT_NE(metadata.find(topic), std::string::npos) << topic;
  EXPECT_EQ(text_of(folder_ / "patches/patch_000000001.navvymap").substr(0, 8), "NAVVYMAP");
  // The volume of the pit is all left to dig: 2 m x 2 m x 0.5 m in columns of 0.2 m, 10 x 10 of
  // them.
  const json design = json::parse(text_of(folder_ / "out/summary.json")).at("design");
  EXPECT_NEAR(design.at("area_m2").get<double>(), 4, 1e-9);
  EXPECT_NEAR(design.at("design_cut_m3").get<double>(), 2, 1e-5);
  EXPECT_NEAR(design.at("under_dig_m3").get<double>(), 2, 1e-5);
  EXPECT_EQ(design.at("over_dig_m3"), 0);
  EXPECT_NEAR(design.at("mean_error_m").get<double>(), 0.5, 1e-5);
  EXPECT_NEAR(design.at("largest_error_m").get<double>(), 0.5, 1e-5);
}

TEST_F(Record, TheLastPublishedMapShowsTheEndOfTheRun) {
  // Once per second, in a run of 0.4 s in which soil falls.
  ASSERT_EQ(navvy({"run", "--out", folder_ / "out", "--publish", folder_ / "patches",
                   "--publish-rate", "1", "--publish-layers", "elevation"},
                  "", kHeap),
            0)
      << text_of(folder_ / "stderr");
  std::vector<float> last;
  const std::vector<json> headers = patches("patches", last);
  ASSERT_EQ(headers.size(), 2u) << "the start and the end";
  EXPECT_EQ(headers[0].at("time_s"), 0);
  EXPECT_EQ(headers[1].at("since"), 1);
  EXPECT_NEAR(headers[1].at("time_s").get<double>(), 0.4, 2e-3);
  EXPECT_GT(headers[1].at("changed"), 0);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "patches/end"));
  const std::vector<float> end = elevation_at_the_end();
  ASSERT_EQ(end.size(), last.size());
  // Both are float32 of one surface, but that of the run was stored in columns once more: the last
  // digit of 1 m is 1e-7.
  for (std::size_t i = 0; i < end.size(); ++i) EXPECT_NEAR(end[i], last[i], 1e-6) << "column " << i;
}

TEST_F(Record, AResetBeginsNewFilesAndReportsReadersThatTimeWentBack) {
  const std::string records =
      R"(<navvy:record name="run"><format>bag</format><rate_hz>10</rate_hz></navvy:record>
<navvy:record name="all"><format>mcap</format><layers>elevation</layers></navvy:record>
<navvy:record name="all_2"><format>npz</format><layers>elevation</layers><rate_hz>10</rate_hz></navvy:record>
)";
  std::string input;
  for (int i = 0; i < 15; ++i) input += "{}\n";
  input += "{\"reset\": true}\n";
  for (int i = 0; i < 6; ++i) input += "{}\n";
  input += "{\"reset\": true}\n{\"end\": true}\n";
  ASSERT_EQ(navvy({"run", "--out", folder_ / "out", "--control", "stdio", "--publish",
                   folder_ / "patches", "--publish-rate", "10", "--publish-layers", "elevation"},
                  records, kHeap, input),
            0)
      << text_of(folder_ / "stderr");
  const std::string list = text_of(folder_ / "out/navvy.run");
  for (const std::string file :
       {"run/run_0.db3", "run/metadata.yaml", "run_2/run_2_0.db3", "run_2/metadata.yaml",
        "run_3/metadata.yaml", "all.mcap", "all_3.mcap", "all_4.mcap", "maps/all_2_00000.npz",
        "maps/all_2_00003.npz", "maps/all_2_2_00000.npz", "maps/all_2_2_00001.npz",
        "maps/all_2_3_00000.npz"}) {
    EXPECT_TRUE(has("out/" + file)) << file;
    EXPECT_NE(list.find(file + "\n"), std::string::npos) << file << " in: " << list;
  }
  // No map was overwritten: 4 maps up to 0.3 s, 2 up to 0.12 s, 1 of the start.
  const auto maps = std::filesystem::directory_iterator(folder_ / "out/maps");
  EXPECT_EQ(std::distance(begin(maps), end(maps)), 7);
  // Each bag has its own times: poses at 50 Hz for 0.3 s and for 0.12 s.
  EXPECT_EQ(messages("run", "/tf"), 16);
  EXPECT_EQ(messages("run", "/clock"), 16);
  EXPECT_EQ(messages("run", "/terrain/grid_map"), 4);
  EXPECT_EQ(messages("run_2", "/tf"), 7);
  EXPECT_EQ(messages("run_2", "/terrain/grid_map"), 2);
  EXPECT_NE(metadata("run").find("nanoseconds: 300000000\n"), std::string::npos) << metadata("run");
  EXPECT_NE(metadata("run_2").find("nanoseconds: 120000000\n"), std::string::npos)
      << metadata("run_2");
  for (const char* bag : {"run", "run_2", "run_3"})
    EXPECT_NE(metadata(bag).find("nanoseconds_since_epoch: 0\n"), std::string::npos) << bag;
  // Readers of patches get whole maps when time goes back, and the last map is that of the start.
  std::vector<float> last;
  const std::vector<json> headers = patches("patches", last);
  int anew = 0;
  for (std::size_t i = 1; i < headers.size(); ++i) {
    const bool back = headers[i].at("time_s") < headers[i - 1].at("time_s");
    EXPECT_EQ(headers[i].at("since") == 0, back) << headers[i];
    anew += back ? 1 : 0;
  }
  // Two whole maps, unless the disk was so slow that both went into one patch.
  EXPECT_GE(anew, 1);
  const std::vector<float> end = elevation_at_the_end();
  ASSERT_EQ(end.size(), last.size());
  for (std::size_t i = 0; i < end.size(); ++i) EXPECT_NEAR(end[i], last[i], 1e-6) << "column " << i;
}

TEST_F(Record, ABagHasItsMachinesAtTheirOwnRate) {
  const std::string records = R"(<navvy:record name="a"><format>bag</format></navvy:record>
<navvy:record name="b"><format>bag</format><rate_hz>5</rate_hz><machine_rate_hz>20</machine_rate_hz></navvy:record>
)";
  ASSERT_EQ(navvy({"run", "--out", folder_ / "out"}, records), 0) << text_of(folder_ / "stderr");
  // 0.4 s at the default rates: 50 Hz, and a map per second.
  for (const char* topic : {"/clock", "/tf", "/m/odom", "/m/joint_states"}) {
    EXPECT_EQ(messages("a", topic), 21) << topic;
    EXPECT_EQ(messages("b", topic), 9) << topic;
  }
  EXPECT_EQ(messages("a", "/terrain/grid_map"), 1);
  EXPECT_EQ(messages("b", "/terrain/grid_map"), 3);
  // The scene in the results records the same.
  EXPECT_NE(text_of(folder_ / "out/scene.sdf").find("<machine_rate_hz>20</machine_rate_hz>"),
            std::string::npos);
  // An element without effect is reported as a mistake.
  EXPECT_EQ(
      navvy(
          {"check"},
          R"(<navvy:record name="a"><format>npz</format><machine_rate_hz>20</machine_rate_hz></navvy:record>
)"),
      2);
  const std::string said = text_of(folder_ / "stdout");
  for (const char* part : {"s.sdf:6", "navvy:record[a]/machine_rate_hz", "only mcap and bag"})
    EXPECT_NE(said.find(part), std::string::npos) << part << " in: " << said;
}

TEST_F(Record, ReportsAnUnknownFormatOrLayerWithItsLineBeforeTheRun) {
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

TEST_F(Record, RefusesADigSetWithoutADesign) {
  std::string bare = scene(R"(<navvy:record name="dig"><format>terra</format></navvy:record>)");
  const std::size_t from = bare.find("<navvy:design>"), end = bare.find("</navvy:design>") + 15;
  bare.erase(from, end - from);
  std::ofstream(folder_ / "bare.sdf") << bare;
  const int status = test::wait_for(test::start({NAVVY_PROGRAM,
                                                 {"check", folder_ / "bare.sdf"},
                                                 {},
                                                 "/dev/null",
                                                 folder_ / "stdout",
                                                 folder_ / "stderr"}));
  EXPECT_EQ(status, 2);
  const std::string said = text_of(folder_ / "stdout");
  for (const char* part :
       {"navvy:record[dig]/format", "'terra'", "needs a design", "<navvy:design>"})
    EXPECT_NE(said.find(part), std::string::npos) << part << " in: " << said;
}

TEST_F(Record, AWrongAddressOrLayerToPublishKeepsEarlierResults) {
  ASSERT_EQ(navvy({"run", "--out", folder_ / "out"}, ""), 0);
  const std::string before = text_of(folder_ / "out/summary.json");
  EXPECT_EQ(json::parse(before).at("status"), "finished");
  // A port in use, a folder that is not empty, and wrong names.
  const int taken = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t length = sizeof address;
  ASSERT_EQ(::bind(taken, reinterpret_cast<const sockaddr*>(&address), length), 0);
  ASSERT_EQ(::listen(taken, 1), 0);
  ::getsockname(taken, reinterpret_cast<sockaddr*>(&address), &length);
  const std::vector<std::pair<std::vector<std::string>, std::string>> slips = {
      {{"--publish", "tcp:" + std::to_string(ntohs(address.sin_port))}, "cannot listen there"},
      {{"--publish", "tcp:99999999"}, "is not a port from 0 to 65535"},
      {{"--publish", folder_ / "out"}, "already: patches are numbered from 1"},
      {{"--publish", folder_ / "s.sdf"}, "exists and is not a folder"},
      {{"--publish", folder_ / "maps", "--publish-layers", "elevtion"}, "elevation"}};
  for (const auto& [options, part] : slips) {
    SCOPED_TRACE(options[1]);
    std::vector<std::string> words = {"run", "--out", folder_ / "out"};
    words.insert(words.end(), options.begin(), options.end());
    EXPECT_EQ(navvy(words, ""), 2);
    EXPECT_NE(text_of(folder_ / "stderr").find(part), std::string::npos)
        << text_of(folder_ / "stderr");
    EXPECT_EQ(text_of(folder_ / "out/summary.json"), before);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out.previous"));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "maps"));
  }
  ::close(taken);
}

TEST_F(Record, RefusesAnAddressOfAnUnknownKind) {
  EXPECT_EQ(navvy({"run", "--out", folder_ / "out", "--publish", "udp:5005"}, ""), 2);
  const std::string said = text_of(folder_ / "stderr");
  for (const char* part : {"'udp:5005'", "tcp:PORT", "./udp:5005"})
    EXPECT_NE(said.find(part), std::string::npos) << part << " in: " << said;
  EXPECT_FALSE(std::filesystem::exists("udp:5005"));
}

}  // namespace
}  // namespace navvy
