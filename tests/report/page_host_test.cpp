// SPDX-License-Identifier: Apache-2.0
// Pages of folders that were written by hand: whole, killed and damaged ones.
#include "report/page.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "core/base64.h"
#include "core/error.h"
#include "folder.h"
#include "report/pages.h"

namespace navvy::report {
namespace {

using nlohmann::json;
using testing::data_of;
using testing::heights_at;
using testing::unpacked;

template <class T>
std::string plain(const std::vector<T>& values) {
  return base64(std::as_bytes(std::span(values)));
}

/// A run's folder of one machine with one link on 20 x 18 columns.
class Page : public ::testing::Test {
 protected:
  Page() {
    write("run.json", R"({"format":1,"version":"0","device":"a device"})");
    write("summary.json", R"({"scenario":"dig","status":"finished"})");
    write("scene.sdf", "<sdf/>");
    write("telemetry.csv",
          "time [s],m/x/velocity [m/s],m/phase\n0,1.5,drag\n0.02,2.5,drag\n0.04,3.5,curl\n");
    header_ = {
        {"format", 1},
        {"grid",
         {{"nx", 20},
          {"ny", 18},
          {"cell_m", 0.1},
          {"origin_m", {-1, -2}},
          {"unit_m", 0.001},
          {"base_m", 5},
          {"particle_unit_m", 0.01},
          {"whole_site", true}}},
        {"start", plain(std::vector<std::int16_t>(20 * 18, 100))},
        {"design", nullptr},
        {"soils", json::array({{{"name", "loam"}, {"color", {1, 0, 0}}}})},
        {"machines", {"m"}},
        {"links", json::array({{{"machine", "m"}, {"link", "base"}, {"visuals", json::array()}}})},
        {"cylinders", json::array()},
        {"forces", json::array()}};
  }

  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  /// Returns the row of a frame in which tile (1, 1) has the height `number`, or no tile changed.
  static std::string frame(double time, int number) {
    std::vector<std::int16_t> tile;
    if (number != 0) {
      tile = {1, 1};
      tile.resize(2 + 256, static_cast<std::int16_t>(number));
    }
    return json{{"time_s", time},
                {"key", false},
                {"tiles", plain(tile)},
                {"poses", plain(std::vector<float>{static_cast<float>(time), 0, 0, 1, 0, 0, 0})},
                {"cylinders", ""},
                {"forces", ""},
                {"particles", plain(std::vector<std::int16_t>{1, 2, 3})},
                {"phases", {"drag"}}}
               .dump() +
           "\n";
  }
  void write_replay(const std::string& rows) {
    write("replay.jsonl", header_.dump() + "\n" + rows);
  }
  std::string page() {
    write_page({folder_.path().string()}, folder_ / kPageName);
    return test::text_of(folder_ / kPageName);
  }
  json run() { return data_of(page()).at("runs").at(0); }
  std::string notes() {
    const json one = run();
    std::string out;
    for (const json& note : one.at("notes")) out += note.get<std::string>() + "\n";
    return out;
  }

  test::Folder folder_;
  json header_;
};

TEST_F(Page, HoldsWhatTheRunWrote) {
  write_replay(frame(0, 0) + frame(0.2, 50) + frame(0.4, 0) + frame(0.6, -7));
  const json one = run();
  EXPECT_EQ(one.at("name"), "dig");
  EXPECT_EQ(one.at("complete"), true);
  EXPECT_EQ(one.at("summary").at("status"), "finished");
  EXPECT_EQ(one.at("scene_text"), "<sdf/>");
  EXPECT_EQ(one.at("notes"), json::array());
  EXPECT_EQ(one.at("telemetry").at("names"), (json{"time", "m/x/velocity"}));
  EXPECT_EQ(one.at("telemetry").at("units"), (json{"s", "m/s"}));
  EXPECT_EQ(unpacked<float>(one.at("telemetry").at("values")),
            (std::vector<float>{0, 1.5f, 0.02f, 2.5f, 0.04f, 3.5f}));
  const json& spans = one.at("phases").at(0).at("spans");
  ASSERT_EQ(spans.size(), 2u);
  EXPECT_EQ(spans[0], (json{{"name", "drag"}, {"start_s", 0.0}, {"end_s", 0.04}}));
  EXPECT_EQ(one.at("frames").at("times"), (json{0.0, 0.2, 0.4, 0.6}));
  EXPECT_EQ(unpacked<float>(one.at("frames").at("poses")).at(7), 0.2f);
  // Column (16, 16) is in the tile, (15, 15) is not.
  const std::size_t in = 16 * 20 + 16, out = 15 * 20 + 15;
  EXPECT_NEAR(heights_at(one, 0.1)[in], 5.1, 1e-9);
  EXPECT_NEAR(heights_at(one, 0.5)[in], 5.05, 1e-9);
  EXPECT_NEAR(heights_at(one, 0.6)[in], 4.993, 1e-9);
  EXPECT_NEAR(heights_at(one, 0.6)[out], 5.1, 1e-9);
}

TEST_F(Page, NamesCannotEndTheScript) {
  write("summary.json", R"({"scenario":"</script><b>x","status":"finished"})");
  write("scene.sdf", "<sdf></script><script>alert(1)</script></sdf>");
  const std::string text = page();
  const json data = data_of(text);
  ASSERT_FALSE(data.is_discarded());
  EXPECT_EQ(data.at("runs").at(0).at("name"), "</script><b>x");
  EXPECT_EQ(text.find("alert(1)</script>"), std::string::npos);
  EXPECT_EQ(text.find("<b>x"), std::string::npos);
  EXPECT_NE(text.find("&lt;/script&gt;&lt;b&gt;x"), std::string::npos) << "the title";
}

TEST_F(Page, OfARunThatWasKilledShowsWhatThereIs) {
  write("summary.json", R"({"scenario":"dig","status":"running"})");
  write("telemetry.csv", "time [s],m/phase\n0,drag\n0.0");
  const std::string whole = frame(0, 0), cut = frame(0.2, 50);
  write_replay(whole + cut.substr(0, cut.size() / 2));
  const json one = run();
  EXPECT_EQ(one.at("complete"), false);
  EXPECT_EQ(one.at("telemetry").at("rows"), 1);
  EXPECT_EQ(one.at("frames").at("times"), (json{0.0}));
  EXPECT_NE(notes().find("killed"), std::string::npos) << notes();
}

TEST_F(Page, OfAFolderWithNothingElseSaysWhatIsMissing) {
  for (const char* name : {"summary.json", "scene.sdf", "telemetry.csv"})
    std::filesystem::remove(folder_ / name);
  const json one = run();
  EXPECT_TRUE(one.at("summary").is_null());
  EXPECT_TRUE(one.at("grid").is_null());
  EXPECT_TRUE(one.at("telemetry").is_null());
  const std::string all = notes();
  for (const char* part : {"summary.json is missing", "replay.jsonl", "no telemetry"})
    EXPECT_NE(all.find(part), std::string::npos) << all;
}

TEST_F(Page, DamagedRowsAreLeftOutAndCounted) {
  std::string text = frame(0.2, 50);
  text.replace(text.find("\"poses\":\"") + 9, 4, "");
  write_replay(frame(0, 0) + "{\"poses\":3}\nnothing\n" + text + frame(0.4, 30) +
               "{\"picture\":\"side\",\"number\":0,\"time_s\":0,\"pose\":[]}\n");
  EXPECT_EQ(run().at("frames").at("times"), (json{0.0, 0.4}));
  EXPECT_NE(notes().find("3 rows of replay.jsonl could not be read"), std::string::npos) << notes();
  // A header of another kind is refused, and the page says so.
  write("replay.jsonl", "{\"a\":1}\n" + frame(0, 0));
  EXPECT_NE(notes().find("is not the file of a replay"), std::string::npos) << notes();
  header_["links"][0]["visuals"] = json::array({{{"mesh", {{"points", "abc"}}}}});
  write_replay(frame(0, 0));
  EXPECT_NE(notes().find("a mesh that cannot be read"), std::string::npos) << notes();
}

TEST_F(Page, LongRunsAreThinnedAndSaySo) {
  std::string rows, table = "time [s],m/phase\n";
  for (int i = 0; i < 4000; ++i) {
    rows += frame(0.2 * i, i % 3 == 0 ? i % 1000 + 1 : 0);
    table += std::to_string(0.2 * i) + ",drag\n";
  }
  write("telemetry.csv", table);
  write_replay(rows);
  const json one = run();
  // Every third frame and the last one; the change of a frame that was left out is in the next.
  EXPECT_EQ(one.at("frames").at("times").size(), 1334u);
  EXPECT_NEAR(one.at("frames").at("times").back().get<double>(), 799.8, 1e-9);
  EXPECT_EQ(one.at("telemetry").at("rows"), 2000);
  EXPECT_NEAR(heights_at(one, 1e9)[16 * 20 + 16], 5 + 0.001 * (3999 % 1000 + 1), 1e-9);
  EXPECT_NE(notes().find("one of 3 frames out of 4000"), std::string::npos) << notes();
  EXPECT_NE(notes().find("one of 2 rows out of 4000"), std::string::npos) << notes();
  EXPECT_LT(std::filesystem::file_size(folder_ / kPageName), 5'000'000u);
}

TEST_F(Page, SmallVideosAreInThePageAndLargeOnesLinked) {
  std::filesystem::create_directory(folder_ / "frames");
  write("frames/side.mp4", "small");
  write("frames/top.webm", std::string(3'000'000, 'x'));
  write("frames/side_00010.png", "picture");
  const json videos = run().at("videos");
  ASSERT_EQ(videos.size(), 2u);
  EXPECT_EQ(videos[0].at("type"), "video/mp4");
  EXPECT_EQ(base64_bytes(videos[0].at("data").get<std::string>()), "small");
  EXPECT_EQ(videos[1].at("file"), "frames/top.webm");
  EXPECT_NE(notes().find("top.webm"), std::string::npos);
  // Without videos, the last picture of each camera.
  std::filesystem::remove(folder_ / "frames/side.mp4");
  std::filesystem::remove(folder_ / "frames/top.webm");
  write("frames/side_00011.png", "last");
  const json pictures = run().at("pictures");
  ASSERT_EQ(pictures.size(), 1u);
  EXPECT_EQ(pictures[0].at("camera"), "side");
  EXPECT_EQ(base64_bytes(pictures[0].at("data").get<std::string>()), "last");
}

TEST_F(Page, PathsOfStepsAreLines) {
  write("paths.csv",
        "machine,step,plan,when,s,x,y,yaw,direction\nm,1,1,0,0,1,2,0,1\nm,1,1,0,0.1,3,4,0,1\n"
        "m,1,2,5,0,5,6,0,1\nbroken\n");
  const json paths = run().at("paths");
  ASSERT_EQ(paths.size(), 2u);
  EXPECT_EQ(paths[0].at("points"), (json{{1.0, 2.0}, {3.0, 4.0}}));
  EXPECT_EQ(paths[1].at("machine"), "m");
}

TEST_F(Page, IsRefusedForWhatIsNoRun) {
  const std::filesystem::path other = folder_ / "other";
  std::filesystem::create_directory(other);
  const auto message = [&](const std::vector<std::string>& runs) -> std::string {
    try {
      write_page(runs, (other / "page.html").string());
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  const std::string none = message({other.string()});
  EXPECT_NE(none.find("neither run.json nor summary.json"), std::string::npos) << none;
  EXPECT_NE(none.find("name the folder"), std::string::npos) << none;
  EXPECT_NE(message({"/nowhere"}), "");
  EXPECT_NE(message({}), "");
  const std::string run = folder_.path().string();
  EXPECT_NE(message({run, run, run}), "");
  EXPECT_FALSE(std::filesystem::exists((other / "page.html").string()));
  EXPECT_EQ(message({run, run}), "");
  EXPECT_EQ(data_of(test::text_of((other / "page.html").string())).at("runs").size(), 2u);
  EXPECT_THROW(write_page({run}, "/nowhere/page.html"), FileError);
}

}  // namespace
}  // namespace navvy::report
