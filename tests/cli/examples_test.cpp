// SPDX-License-Identifier: Apache-2.0
// The example programs of examples/robot and examples/planner, as users run them.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "cli/program_run.h"
#include "paths.h"
#include "process.h"
#include "text_of.h"

namespace navvy::test {
namespace {

class Examples : public ProgramRun {
 protected:
  /// Runs a program of examples/robot by Debian's Python and returns its exit status. What it
  /// prints is in the file `example`.
  int example(const std::string& name, std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), source_dir() + "/examples/robot/" + name);
    return wait_for(
        test::start({"/usr/bin/python3", arguments, environment_, "/dev/null",
                     (directory_ / "example").string(), (directory_ / "example_errors").string()}));
  }
  std::string printed() const { return text_of(directory_ / "example"); }
  /// Returns true if Debian's Python has NumPy.
  static bool has_numpy() {
    return std::system("/usr/bin/python3 -c 'import numpy' >/dev/null 2>&1") == 0;
  }
};

// The crate stands in the way twice, at places that the program does not know.
TEST_F(Examples, ARobotDrivesAroundAMovedBoxByItsScanAlone) {
  for (const std::string crate : {"-0.5 -2", "0.6 -2.2"}) {
    ASSERT_EQ(example("avoid_box.py", {"--navvy", NAVVY_PROGRAM, "--crate", crate, "--out", out()}),
              0)
        << text_of(directory_ / "example_errors");
    double left = 9, nearest = 0;
    ASSERT_EQ(std::sscanf(printed().c_str(),
                          "%lf m from its goal; nothing came closer to the scanner than %lf m",
                          &left, &nearest),
              2)
        << printed();
    EXPECT_LE(left, 0.2) << crate;
    // The scanner stands 0.14 m before the middle of a robot that is 0.36 m wide.
    EXPECT_GE(nearest, 0.25) << crate;
  }
}

// One scoop of each of two cells; the third is out of reach, so that its order is refused.
TEST_F(Examples, AProgramOrdersDigsAndIsToldWhyOneIsRefused) {
  const std::string first = "3.65 0 1.85 0", second = "3.26 -2.19 1.57 -1.57", third = "9 0 8 0";
  ASSERT_EQ(example("order_digs.py", {"--navvy", NAVVY_PROGRAM, "--cycles", "1", "--out", out(),
                                      "--cells", first, second, third}),
            0)
      << text_of(directory_ / "example_errors");
  const std::string text = printed();
  for (const std::string& cell : {first, second})
    EXPECT_NE(text.find("cell " + cell + " is ordered"), std::string::npos) << text;
  EXPECT_NE(text.find("order:1: error"), std::string::npos) << text;
  const nlohmann::json program = summary().at("programs").at(0);
  EXPECT_EQ(program.at("orders"), 2);
  EXPECT_EQ(program.at("state"), "done") << text;
  // The scene's own program, and each order.
  ASSERT_EQ(program.at("step_list").size(), 3u);
  EXPECT_EQ(program.at("step_list")[0].at("state"), "replaced");
  for (int i = 1; i < 3; ++i)
    EXPECT_LT(program.at("step_list")[i].at("volume_left_m3"),
              program.at("step_list")[i].at("design_volume_m3"));
  EXPECT_EQ(summary().at("cycles"), 2);
  EXPECT_EQ(summary().at("mass_ledger").at("error_units"), 0);
}

TEST_F(Examples, AnotherProcessFollowsTheScansOfARun) {
  if (!has_numpy()) GTEST_SKIP() << "NumPy is missing";
  const pid_t run = start({"run", "paper/diff_physics", "--no-render", "--duration", "20", "--out",
                           out(), "--publish-sensors", "tcp:0"});
  const std::string before = "readings of sensors on port ";
  std::string port;
  for (int i = 0; i < 600 && port.empty(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    const std::string text = complained();
    if (const std::size_t at = text.find(before); at != std::string::npos)
      if (const std::size_t end = text.find('\n', at); end != std::string::npos)
        port = text.substr(at + before.size(), end - at - before.size());
  }
  ASSERT_FALSE(port.empty()) << complained();
  EXPECT_EQ(example("follow_scans.py", {port, "robot/laser/ranges"}), 0)
      << text_of(directory_ / "example_errors");
  EXPECT_EQ(wait_for(run), 0) << complained();
  // The reader connects after the start, and the run does not wait for it.
  const std::string text = printed();
  const auto lines = std::count(text.begin(), text.end(), '\n');
  EXPECT_GT(lines, 10) << text;
  EXPECT_NE(text.find("robot/laser/ranges"), std::string::npos);
}

// An L: the leg is dug after the bar, together with the row of the bar that it ends at.
TEST_F(Examples, ADigOfAPlanMapReachesIntoTheOneBesideIt) {
  if (!has_numpy()) GTEST_SKIP() << "NumPy is missing";
  const std::string look =
      "import sys, numpy as n\n"
      "sys.path.insert(0, sys.argv[1])\n"
      "import dig_plan_map as d\n"
      "a = n.zeros((9, 9), bool)\n"
      "a[1:4, 1:8] = a[4:7, 1:4] = True\n"
      "bar, leg = d.rectangles(a)\n"
      "assert bar.sum() == 21 and leg.sum() == 9, (bar, leg)\n"
      "assert (d.overlapping(bar, n.zeros_like(a)) == bar).all()\n"
      "grown = d.overlapping(leg, bar)\n"
      "assert grown[3:7, 1:4].all() and grown.sum() == 12, grown\n";
  EXPECT_EQ(wait_for(test::start(
                {"/usr/bin/python3", {"-B", "-c", look, source_dir() + "/examples/planner"}, {}})),
            0);
}

// Two digs and the only places for their spoil; then one with a hole.
TEST_F(Examples, APlanMapBecomesASceneThatTheCheckAccepts) {
  if (!has_numpy()) GTEST_SKIP() << "NumPy is missing";
  const std::string make =
      "import sys, numpy as n, pathlib as p\n"
      "f = p.Path(sys.argv[1])\n"
      "def save(k, image):\n"
      "    for name in ('images', 'occupancy', 'dumpability'):\n"
      "        (f / name).mkdir(parents=True, exist_ok=True)\n"
      "        a = image if name == 'images' else n.full_like(image, name == 'dumpability')\n"
      "        n.save(f / name / f'img_{k}.npy', a)\n"
      "a = n.zeros((28, 40), 'int8')\n"
      "a[12:14, 14:20] = a[17:18, 26:34] = -1\n"
      "a[5:9, 4:34] = a[20:25, 6:38] = 1\n"
      "save(1, a)\n"
      "a[12:15, 14:20] = -1; a[13, 16] = 0\n"
      "save(2, a)\n";
  const std::string folder = (directory_ / "maps").string(),
                    scene = (directory_ / "plan.sdf").string();
  ASSERT_EQ(wait_for(test::start({"/usr/bin/python3", {"-c", make, folder}, {}})), 0);
  const auto plan = [&](const char* number) {
    return example("../planner/dig_plan_map.py",
                   {folder, "--number", number, "--out", scene, "--navvy", NAVVY_PROGRAM});
  };
  ASSERT_EQ(plan("1"), 0) << text_of(directory_ / "example_errors");
  EXPECT_NE(printed().find("2 digs"), std::string::npos) << printed();
  ASSERT_EQ(run({"check", scene}), 0) << complained();
  EXPECT_NE(plan("2"), 0);
  EXPECT_NE(text_of(directory_ / "example_errors").find("has a hole: divide it"), std::string::npos)
      << text_of(directory_ / "example_errors");
  EXPECT_NE(plan("7"), 0);
  EXPECT_NE(text_of(directory_ / "example_errors").find("img_7.npy: cannot be read"),
            std::string::npos);
}

}  // namespace
}  // namespace navvy::test
