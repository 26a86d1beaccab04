// SPDX-License-Identifier: Apache-2.0
// Controllers that send faulty lines, flood the program, or disconnect.
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "folder.h"
#include "paths.h"
#include "process.h"
#include "text_of.h"

namespace navvy {
namespace {

using nlohmann::json;

using test::text_of;

class Control : public testing::Test {
 protected:
  std::vector<std::string> arguments(const std::string& scene = "bucket_path") const {
    return {"run",          navvy::source_dir() + "/scenarios/" + scene + ".sdf",
            "--no-render",  "--control",
            "stdio",        "--out",
            folder_ / "out"};
  }
  /// Runs the program with `input` sent at once and returns its exit status; its output lines go to
  /// `lines`.
  int drive(const std::string& input, std::vector<json>& lines,
            const std::string& scene = "bucket_path") {
    std::ofstream(folder_ / "in") << input;
    const int status = test::wait_for(test::start({NAVVY_PROGRAM,
                                                   arguments(scene),
                                                   {},
                                                   folder_ / "in",
                                                   folder_ / "stdout",
                                                   folder_ / "stderr"}));
    std::istringstream said(text_of(folder_ / "stdout"));
    for (std::string line; std::getline(said, line);) lines.push_back(json::parse(line));
    return status;
  }
  json summary() const {
    return json::parse(text_of(folder_ / "out/summary.json"), nullptr, false);
  }
  std::string complained() const { return text_of(folder_ / "stderr"); }

  const test::Folder folder_;
};

TEST_F(Control, AnswersAFaultyLineAndContinuesTheRun) {
  const std::vector<std::pair<std::string, std::string>> bad = {
      {R"({"inputs": {"bucket/slyde_x/velocity": 1}})", "bucket/slide_x/velocity"},
      {R"({"inputs": {"bucket/slide_x/velocity": 1, "bucket/slyde_x/velocity": 1}})",
       "bucket/slide_x/velocity"},
      {R"({"inputs": {"bucket/slide_x/velocity": "fast"}})", "must be a number"},
      {R"({"inputs": {"bucket/slide_x/velocity": 1e999}})", "one JSON object"},
      {R"({"inputs": [1, 2]})", "object of names"},
      {R"({"input": {}})", "'inputs' or 'end'"},
      {R"({"end": "now"})", "true or false"},
      {"", "one JSON object"},
      {"drive!", "one JSON object"},
      {"\"\xff\xfe\"", "one JSON object"},
      {"null", "one JSON object"},
      {std::string(3, '\0'), "one JSON object"},
      // The text after a NUL is part of the answer.
      {R"({"inputs": {"a\u0000b": 1}})", "a\\x00b"},
      {R"({"inputs": {"bucket/slide_x/velocity": 1}, "inputs": {}})", "inputs: stands twice"},
      {R"({"inputs": {"bucket/slide_x/velocity": 1, "bucket/slide_x/velocity": 0}})",
       "bucket/slide_x/velocity: stands twice"},
      {R"({"changed": {"a": [{"b": 1, "b": 2}]}})", "b: stands twice"},
  };
  std::string input;
  for (const auto& [line, message] : bad) input += line + "\n";
  input += "{\"inputs\": {\"bucket/slide_x/velocity\": 0}}\n{\"end\": true}\n";
  std::vector<json> lines;
  ASSERT_EQ(drive(input, lines), 0) << complained();
  ASSERT_EQ(lines.size(), bad.size() + 2);
  EXPECT_EQ(lines[0].at("time"), 0);
  for (std::size_t i = 0; i < bad.size(); ++i) {
    EXPECT_EQ(lines[i + 1].at("line"), i + 1);
    EXPECT_NE(lines[i + 1].at("error").get<std::string>().rfind("error", 0), 0u)
        << "the key identifies the fault";
    EXPECT_NE(lines[i + 1].at("error").get<std::string>().find(bad[i].second), std::string::npos)
        << bad[i].first << ": " << lines[i + 1];
  }
  // The second bad line also names a valid input, which must not take effect.
  EXPECT_NEAR(lines.back().at("time").get<double>(), 0.02, 0.003);
  EXPECT_EQ(summary().at("status"), "finished");
}

TEST_F(Control, AnswersRequestsWhileTimeIsPaused) {
  const std::string snapshot = folder_ / "s.snapshot";
  const std::string input = R"({"info": true}
{"heights": {"min_m": [-0.5, -0.5], "max_m": [0.5, 0], "cell_m": 0.25}}
{"heights": {"min_m": [-0.5, -0.5], "max_m": [0.5, 0], "cell_m": 0.25, "layer": "slope"}}
{"changed": 0}
{"changed": 1}
{"save": ")" + snapshot + R"("}
{"save": ")" + snapshot + R"("}
{}
{"load": ")" + snapshot + R"("}
{}
{}
{"reset": true}
{"end": true}
)";
  std::vector<json> lines;
  ASSERT_EQ(drive(input, lines), 0) << complained();
  ASSERT_EQ(lines.size(), 15u);
  const json& info = lines[1].at("info");
  EXPECT_EQ(info.at("scene"), "bucket_path");
  EXPECT_EQ(info.at("time"), 0);
  EXPECT_EQ(info.at("layers").at("slope"), "rad");
  EXPECT_EQ(info.at("inputs").at("bucket/slide_x/velocity"), "m/s");
  const json& heights = lines[2].at("heights");
  EXPECT_EQ(heights.at("nx"), 4);
  EXPECT_EQ(heights.at("ny"), 2);
  ASSERT_EQ(heights.at("values").size(), 8u);
  EXPECT_NEAR(heights.at("values")[5].get<double>(), 0, 1e-6);
  EXPECT_EQ(lines[3].at("heights").at("unit"), "rad");
  EXPECT_EQ(lines[4].at("changed").at("rects_m").size(), 1u);
  EXPECT_EQ(lines[4].at("changed").at("sequence"), 1);
  EXPECT_EQ(lines[5].at("changed").at("rects_m").size(), 0u);
  EXPECT_EQ(lines[6].at("save").at("file"), snapshot);
  EXPECT_EQ(lines[7], lines[6]) << "a snapshot may be replaced";
  // One control step forwards and back: the outputs repeat.
  EXPECT_NEAR(lines[8].at("time").get<double>(), 0.02, 0.003);
  EXPECT_EQ(lines[9].at("load").at("time"), 0);
  EXPECT_EQ(lines[10], lines[0]);
  EXPECT_EQ(lines[11], lines[8]) << "repeating the step is bit-identical";
  EXPECT_NEAR(lines[12].at("time").get<double>(), 0.04, 0.003);
  EXPECT_EQ(lines[13].at("reset").at("time"), 0);
  EXPECT_EQ(lines[14], lines[0]);
}

TEST_F(Control, ReportsChangesSinceTheSequenceNumberOfHeights) {
  // The bucket goes down at 1 m/s from 0.2 m above the ground; heights are requested before it
  // reaches the ground and when it is in it.
  std::string down = "{\"inputs\": {\"bucket/slide_z/velocity\": -1}}\n",
              input = "{\"heights\": {\"cell_m\": 1}}\n" + down;
  for (int i = 0; i < 25; ++i) input += "{}\n";
  input += R"({"heights": {"cell_m": 1}}
{"changed": 1}
{"heights": {"layer": "disturbed_at"}}
{"heights": {"cell_m": 1}}
{}
{}
{"changed": 2}
{"changed": 3}
{"changed": 0}
{"reset": true}
{"heights": {"layer": "disturbed_at"}}
{"changed": 3}
{"changed": 4}
{"end": true}
)";
  std::vector<json> lines;
  ASSERT_EQ(drive(input, lines), 0) << complained();
  std::vector<json> heights, changed;
  for (const json& line : lines) {
    ASSERT_FALSE(line.contains("error")) << line;
    if (line.contains("heights")) heights.push_back(line.at("heights"));
    if (line.contains("changed")) changed.push_back(line.at("changed"));
  }
  ASSERT_EQ(heights.size(), 5u);
  ASSERT_EQ(changed.size(), 6u);
  // One map per change, for all requests: the start, after the dig, two steps later, and the start
  // again.
  EXPECT_EQ(heights[0].at("sequence"), 1);
  EXPECT_EQ(heights[1].at("sequence"), 2);
  EXPECT_EQ(heights[3].at("sequence"), 2);
  EXPECT_EQ(changed[0].at("since"), 1);
  EXPECT_EQ(changed[0].at("sequence"), 2);
  EXPECT_GT(changed[0].at("columns"), 0);
  // Soil moves in every step: the number of the last map that was read selects the changes after
  // it.
  EXPECT_EQ(changed[1].at("since"), 2);
  EXPECT_EQ(changed[1].at("sequence"), 3);
  EXPECT_GT(changed[1].at("columns"), 0);
  EXPECT_GT(changed[1].at("rects_m").size(), 0u);
  EXPECT_GT(changed[1].at("map_time"), heights[3].at("map_time"));
  EXPECT_EQ(changed[1].at("map_time"), changed[1].at("time"));
  EXPECT_EQ(changed[2].at("columns"), 0);
  EXPECT_EQ(changed[2].at("time"), changed[1].at("time"));
  EXPECT_EQ(changed[3].at("since"), 0);
  // After the first request, soil that changed is known; a changed slope beside it is not.
  const auto known = [](const json& answer) {
    const json& values = answer.at("values");
    return std::count_if(values.begin(), values.end(),
                         [](const json& value) { return !value.is_null(); });
  };
  EXPECT_GT(known(heights[2]), 0);
  EXPECT_LE(known(heights[2]), changed[0].at("columns"));
  // After the reset: time is earlier, the earlier history is unknown, and no earlier number is
  // valid.
  EXPECT_EQ(heights[4].at("sequence"), 4);
  EXPECT_EQ(heights[4].at("map_time"), 0);
  EXPECT_EQ(known(heights[4]), 0);
  EXPECT_EQ(changed[4].at("since"), 0);
  EXPECT_GT(changed[4].at("columns"), changed[0].at("columns"));
  EXPECT_EQ(changed[5].at("columns"), 0);
}

TEST_F(Control, AFailedRequestDoesNotAffectTheRun) {
  std::ofstream(folder_ / "bad.snapshot") << "navvy state of nothing";
  std::ofstream(folder_ / "ctl.py") << "print('drive')";
  const std::vector<std::pair<std::string, std::string>> bad = {
      {R"({"heights": {"cell_m": 0.0001, "min_m": [0, 0]}})", "cell_m"},
      {R"({"heights": {"cell_m": 0.002}})", "1000000 cells"},
      {R"({"heights": {"layer": "slop"}})", "slope"},
      {R"({"heights": {"max": [1, 1]}})", "max_m"},
      {R"({"heights": {"min_m": [1, 1], "max_m": [0, 2]}})", "rectangle"},
      {R"({"heights": 3})", "must be an object"},
      {R"({"changed": -1})", "whole number"},
      {R"({"watch": "bucket/lft"})", "lift"},
      {R"({"watch": "bucket"})", "must be a machine and one of its links"},
      {R"({"image": "nobody"})", "no camera"},
      {R"({"info": 1})", "must be true"},
      {R"({"reset": true, "inputs": {}})", "two lines"},
      {R"({"save": "/proc/no/such"})", "there is no folder '/proc/no'"},
      {R"({"save": ")" + (folder_ / "ctl.py") + "\"}", "is no snapshot, so it is not replaced"},
      {R"({"load": "/no/such.snapshot"})", "/no/such.snapshot"},
      {R"({"load": ")" + (folder_ / "bad.snapshot") + "\"}", "bad.snapshot"},
  };
  std::string input = "{}\n";
  for (const auto& [line, message] : bad) input += line + "\n";
  input += "{}\n{\"end\": true}\n";
  std::vector<json> lines, plain;
  ASSERT_EQ(drive(input, lines), 0) << complained();
  EXPECT_EQ(text_of(folder_ / "ctl.py"), "print('drive')");
  ASSERT_EQ(lines.size(), bad.size() + 3);
  for (std::size_t i = 0; i < bad.size(); ++i) {
    ASSERT_TRUE(lines[i + 2].contains("error")) << bad[i].first << ": " << lines[i + 2];
    EXPECT_NE(lines[i + 2].at("error").get<std::string>().find(bad[i].second), std::string::npos)
        << bad[i].first << ": " << lines[i + 2];
  }
  ASSERT_EQ(drive("{}\n{}\n{\"end\": true}\n", plain), 0) << complained();
  EXPECT_EQ(lines.back(), plain.back()) << "requests have no side effects";
}

TEST_F(Control, IncludesAWatchedLinkInTheNextOutputs) {
  std::vector<json> lines;
  ASSERT_EQ(drive("{\"watch\": \"bucket/carriage\"}\n{}\n{\"end\": true}\n", lines), 0)
      << complained();
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[1].at("watch").size(), 12u);
  EXPECT_EQ(lines[1].at("watch").at("bucket/carriage/angular_velocity/z"), "rad/s");
  EXPECT_FALSE(lines[0].at("outputs").contains("bucket/carriage/pose/x"));
  EXPECT_TRUE(lines[2].at("outputs").contains("bucket/carriage/pose/x"));
}

TEST_F(Control, SendsThePictureOfACamera) {
  std::vector<json> lines;
  ASSERT_EQ(drive("{\"image\": \"side\"}\n{\"end\": true}\n", lines), 0) << complained();
  ASSERT_EQ(lines.size(), 2u);
  const json& image = lines[1].at("image");
  EXPECT_EQ(image.at("camera"), "side");
  EXPECT_GT(image.at("width"), 0);
  // First eight bytes of every PNG.
  EXPECT_EQ(image.at("png_base64").get<std::string>().substr(0, 10), "iVBORw0KGg");
}

TEST_F(Control, RefusesLinesOfAnySizeAndDepthInOnePass) {
  const std::string deep(100000, '['),
      wide = "{\"inputs\": {\"" + std::string(900000, 'x') + "\": 1}}";
  std::string hidden = R"({"inputs": {"a)" + std::string(1000, '[') + R"(": 1}})", endless;
  endless.assign(100'000'000, 'y');
  const auto begun = std::chrono::steady_clock::now();
  std::vector<json> lines;
  ASSERT_EQ(
      drive(deep + "\n" + wide + "\n" + endless + "\n" + hidden + "\n{}\n{\"end\": true}", lines),
      0)
      << complained();
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begun;
  ASSERT_EQ(lines.size(), 6u);
  const char* const said[] = {"nest at most", "is no input", "at most 1048576 bytes",
                              "no input 'a[[["};
  for (int i = 0; i < 3; ++i)
    EXPECT_NE(lines[static_cast<std::size_t>(i) + 1].at("error").get<std::string>().find(said[i]),
              std::string::npos)
        << lines[static_cast<std::size_t>(i) + 1].dump().substr(0, 300);
  EXPECT_TRUE(lines[4].contains("error"))
      << "brackets inside a string do not nest; the name is unknown";
  std::printf("100 MB of one line and 100 000 brackets: %.1f s with the start of the program\n",
              spent.count());
}

TEST_F(Control, ReportsATargetBeyondAJointsLimitsOncePerInput) {
  const std::string
      beyond = R"({"inputs": {"excavator/boom_joint/position": 90}})",
      other =
          R"({"inputs": {"excavator/arm_joint/position": -4, "excavator/bucket_joint/position": 0}})",
      fast =
          R"({"inputs": {"excavator/boom_joint/velocity": 1e300, "excavator/arm_joint/effort": -1e300}})";
  std::vector<json> lines;
  ASSERT_EQ(drive(beyond + "\n" + beyond + "\n" + other + "\n" + fast + "\n{}\n{\"end\": true}\n",
                  lines, "trench"),
            0)
      << complained();
  EXPECT_EQ(lines.size(), 6u) << "the run continues";
  const std::string said = complained();
  const auto count = [&](const std::string& part) {
    int found = 0;
    for (std::size_t at = said.find(part); at != std::string::npos; at = said.find(part, at + 1))
      ++found;
    return found;
  };
  // The usual cause: degrees instead of radians.
  EXPECT_EQ(count("input excavator/boom_joint/position: 90 rad is beyond the joint's limits, -0.85 "
                  "to 1.05 rad"),
            1)
      << said;
  EXPECT_EQ(count("input excavator/arm_joint/position: -4 rad is beyond the joint's limits, -2.75 "
                  "to -0.6 rad"),
            1)
      << said;
  EXPECT_EQ(count("input excavator/boom_joint/velocity: 1e+300 rad/s is beyond the joint's limits"),
            1)
      << said;
  EXPECT_EQ(count("input excavator/arm_joint/effort: -1e+300 N m is beyond the joint's limits"), 1)
      << said;
  EXPECT_EQ(count("beyond the joint's limits"), 4) << said;
}

TEST_F(Control, AnInputStreamWithoutAnEndMessageEndsAsInterrupted) {
  std::vector<json> lines;
  EXPECT_EQ(drive("{}\n{}\n", lines), 130) << complained();
  EXPECT_EQ(lines.size(), 3u);
  EXPECT_EQ(summary().at("status"), "interrupted");
  EXPECT_NE(summary().at("message").get<std::string>().find("closed standard input"),
            std::string::npos);
}

TEST_F(Control, AClosedStandardOutputEndsTheRun) {
  // Pipes in both directions; our end of its output is closed after the first line.
  int in[2], out[2];
  ASSERT_EQ(pipe2(in, O_CLOEXEC), 0);
  ASSERT_EQ(pipe2(out, O_CLOEXEC), 0);
  const auto by_number = [](int file) { return "/dev/fd/" + std::to_string(file); };
  const pid_t child = test::start(
      {NAVVY_PROGRAM, arguments(), {}, by_number(in[0]), by_number(out[1]), folder_ / "stderr"});
  close(in[0]);
  close(out[1]);
  char first[4096];
  ASSERT_GT(read(out[0], first, sizeof first), 0);
  close(out[0]);
  // Many answers at once: the run does not wait for each of them.
  std::string answers;
  for (int i = 0; i < 1000; ++i) answers += "{}\n";
  ASSERT_GT(write(in[1], answers.data(), answers.size()), 0);
  EXPECT_EQ(test::wait_for(child), 130) << complained();
  close(in[1]);
  EXPECT_EQ(summary().at("status"), "interrupted");
  EXPECT_NE(summary().at("message").get<std::string>().find("closed standard output"),
            std::string::npos);
  EXPECT_LT(summary().at("simulated_time_s").get<double>(), 0.1);
}

}  // namespace
}  // namespace navvy
