// SPDX-License-Identifier: Apache-2.0
// Reports of runs that end while a program of the scene did not finish: status, exit status, last
// lines.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "cli/program_run.h"

namespace navvy {
namespace {

class Ending : public test::ProgramRun {
 protected:
  /// Returns a scene with two buckets on posts, each with a program, on a site of 4 m; the whole
  /// scene ends after `duration` [s].
  std::string two_buckets(const std::string& first, const std::string& second,
                          const std::string& duration) {
    const auto bucket = [](const std::string& name, const std::string& x,
                           const std::string& program) {
      return "<include><uri>model://test_bucket</uri><name>" + name + "</name><pose>" + x +
             " 0 3 0 0 0</pose>" + "<navvy:on_ground>false</navvy:on_ground><navvy:program>" +
             program + "</navvy:program></include>\n";
    };
    const std::string path = (directory_ / "scene.sdf").string();
    std::ofstream(path)
        << "<sdf version=\"1.9\" xmlns:navvy=\"navvy\"><world name=\"two\">\n"
        << "<navvy:soil ref=\"loam\"/><navvy:ground><size_m>8 "
           "4</size_m><depth_m>1</depth_m></navvy:ground>\n"
        << bucket("early", "-2", first) << bucket("late", "2", second)
        << "<navvy:recording><duration_s>" << duration
        << "</duration_s><settle_s>0.05</settle_s></navvy:recording></world></sdf>\n";
    return path;
  }
  pid_t begin(const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"run", "--no-render", "--out", out()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return start(arguments);
  }
  int run(const std::vector<std::string>& more) { return test::wait_for(begin(more)); }
};

const char* const kWait = "<wait><duration_s>0.2</duration_s></wait>";

TEST_F(Ending, IsFinishedWhenAllProgramsAreDone) {
  ASSERT_EQ(run({two_buckets(kWait, kWait, "5")}), 0) << complained();
  EXPECT_EQ(summary().at("status"), "finished");
  for (const nlohmann::json& program : summary().at("programs"))
    EXPECT_EQ(program.at("state"), "done") << program;
  EXPECT_FALSE(summary().contains("message"));
  EXPECT_EQ(said().find("incomplete"), std::string::npos) << said();
}

TEST_F(Ending, HasItsOwnStatusWhenAProgramFailedWhileTheOtherContinues) {
  const std::string impatient =
      "<wait_for><machine>late</machine><longest_s>0.05</longest_s></wait_for>" +
      std::string(kWait);
  EXPECT_EQ(run({two_buckets(impatient, kWait, "5")}), 6) << complained();
  const nlohmann::json written = summary();
  EXPECT_EQ(written.at("status"), "incomplete");
  EXPECT_LT(written.at("simulated_time_s").get<double>(), 1)
      << "the run ends when all programs have ended";
  const nlohmann::json first = written.at("programs").at(0), second = written.at("programs").at(1);
  EXPECT_EQ(first.at("machine"), "early");
  EXPECT_EQ(first.at("state"), "out_of_time");
  EXPECT_EQ(first.at("step"), 1);
  EXPECT_EQ(first.at("steps"), 2);
  EXPECT_NE(first.at("reason").get<std::string>().find("'late' has done 0 of the 1 steps"),
            std::string::npos)
      << first;
  EXPECT_NEAR(first.at("time_s").get<double>(), 0.05, 0.01);
  EXPECT_NEAR(first.at("place_m").at(0).get<double>(), -2, 1e-6);
  EXPECT_EQ(first.at("step_list").size(), 1u);
  EXPECT_EQ(second.at("state"), "done");
  EXPECT_GT(second.at("time_s").get<double>(), 0.19);
  // Reported once when it happens, and again in the last lines.
  const std::string line = "'early', step 1 of 2 (wait_for): out_of_time: ";
  EXPECT_NE(complained().find("warning: " + line), std::string::npos) << complained();
  EXPECT_NE(said().find("incomplete: " + line), std::string::npos) << said();
  EXPECT_EQ(written.at("message").get<std::string>().rfind(line, 0), 0u) << written.at("message");
}

TEST_F(Ending, IsIncompleteWhenTheDurationCutsAProgramOffAndFailsOnlyUnrequested) {
  const std::string scene = two_buckets(kWait, "<wait><duration_s>100</duration_s></wait>", "0.3");
  EXPECT_EQ(run({scene}), 6) << complained();
  EXPECT_EQ(summary().at("status"), "incomplete");
  EXPECT_EQ(summary().at("programs").at(0).at("state"), "done");
  EXPECT_EQ(summary().at("programs").at(1).at("state"), "out_of_time");
  EXPECT_EQ(summary().at("message").get<std::string>().rfind(
                "'late', step 1 of 1 (wait): out_of_time: the run's duration of 0.3 s", 0),
            0u)
      << summary().at("message");
  EXPECT_NE(said().find("the run's duration of 0.3 s was over first"), std::string::npos) << said();
  // A user who asks for this duration gets the same report and no failure.
  EXPECT_EQ(run({scene, "--duration", "0.25"}), 0) << complained();
  EXPECT_EQ(summary().at("status"), "incomplete");
  EXPECT_NE(said().find("the run's duration of 0.25 s was over first"), std::string::npos)
      << said();
}

TEST_F(Ending, ReportsProgramsOfAnInterruptedRunAsInterrupted) {
  const std::string scene =
      two_buckets(kWait, "<wait><duration_s>100000</duration_s></wait>", "100000");
  const pid_t child = begin({scene});
  // Waits until a checkpoint reports the first program as done.
  const auto first_done = [&] {
    const nlohmann::json now = summary();
    return now.is_object() && now.at("programs").at(0).at("state") == "done";
  };
  for (int i = 0; i < 1200 && !first_done(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_EQ(summary().at("programs").at(1).at("state"), "running");
  kill(child, SIGINT);
  EXPECT_EQ(test::wait_for(child), 130) << complained();
  EXPECT_EQ(summary().at("status"), "interrupted");
  EXPECT_EQ(summary().at("programs").at(0).at("state"), "done");
  EXPECT_EQ(summary().at("programs").at(1).at("state"), "interrupted");
  EXPECT_EQ(summary().at("message"), "SIGINT");
  EXPECT_NE(said().find("interrupted: SIGINT, at "), std::string::npos) << said();
}

TEST_F(Ending, ReportsNoProgramAsRunningWhenTheControllerEndsTheRun) {
  const std::string scene = two_buckets(kWait, kWait, "100");
  EXPECT_EQ(ProgramRun::run({"run", scene, "--no-render", "--out", out(), "--control", "stdio"},
                            "{}\n{\"end\": true}\n"),
            0)
      << complained();
  EXPECT_NE(complained().find("interrupted: the controller ended the run"), std::string::npos)
      << complained();
  EXPECT_EQ(complained().find("running"), std::string::npos) << complained();
}

TEST_F(Ending, HasItsOwnStatusWhenAGoalIsMissed) {
  const std::string path = (directory_ / "goal.sdf").string();
  std::ofstream(path)
      << "<sdf version=\"1.9\" xmlns:navvy=\"navvy\"><world name=\"goal\">\n"
         "<navvy:soil ref=\"loam\"/><navvy:ground><size_m>8 8</size_m></navvy:ground>\n"
         "<navvy:design><area><polygon_m>2 2 3 2 3 3 2 3</polygon_m><depth_m>0.5</depth_m></area>"
         "</navvy:design>\n<navvy:solver><cell_m>0.2</cell_m></navvy:solver>\n"
         "<include><uri>model://robot</uri><pose>0 0 0 0 0 0</pose><navvy:program>"
      << kWait
      << "</navvy:program></include>\n<navvy:goals><completion>0.9</completion>"
         "<collisions>0</collisions></navvy:goals>\n"
         "<navvy:recording><duration_s>9</duration_s><settle_s>0.05</settle_s></navvy:recording>"
         "</world></sdf>\n";
  EXPECT_EQ(run({path}), 9) << complained();
  const nlohmann::json written = summary();
  EXPECT_EQ(written.at("status"), "incomplete");
  EXPECT_EQ(written.at("message"), "missed goal: completion is 0, wanted is at least 0.9");
  ASSERT_EQ(written.at("goals").size(), 2u);
  EXPECT_EQ(written.at("goals")[0].at("met"), false);
  EXPECT_EQ(written.at("goals")[1].at("met"), true);
  EXPECT_EQ(written.at("score").at("balance_error_units"), 0);
  EXPECT_NEAR(written.at("score").at("shape").at("design_cut_m3").get<double>(), 0.5, 1e-6);
  // The score can be read again, and compared.
  EXPECT_EQ(ProgramRun::run({"score", out()}), 9) << complained();
  EXPECT_NE(said().find("goal completion: MISSED, is 0, wanted at least 0.9"), std::string::npos)
      << said();
  EXPECT_EQ(ProgramRun::run({"compare", out(), out() + "/summary.json"}), 0) << complained();
  EXPECT_NE(said().find("shape/completion"), std::string::npos) << said();
  EXPECT_EQ(ProgramRun::run({"score", path}), 2);
  EXPECT_NE(complained().find("is not the JSON object of a summary"), std::string::npos)
      << complained();
}

TEST_F(Ending, HasItsOwnStatusAfterAForbiddenEvent) {
  const std::string path = (directory_ / "scene.sdf").string();
  std::ofstream(path)
      << "<sdf version=\"1.9\" xmlns:navvy=\"navvy\"><world name=\"wall\">\n"
         "<navvy:soil ref=\"gravel\"/><navvy:ground><size_m>12 10</size_m></navvy:ground>\n"
         "<navvy:solver><cell_m>0.2</cell_m></navvy:solver>\n"
         "<include><uri>model://robot</uri><pose>-1.2 0 0 0 0 0</pose><navvy:program><drive_to>"
         "<target_m>3 0</target_m><speed_m_per_s>1</speed_m_per_s></drive_to></navvy:program>"
         "</include>\n"
         "<model name=\"wall\"><static>true</static><link name=\"b\"><collision name=\"c\">"
         "<geometry><box><size>0.3 9 1.2</size></box></geometry></collision></link></model>\n"
         "<navvy:recording><duration_s>9</duration_s></navvy:recording></world></sdf>\n";
  EXPECT_EQ(run({path, "--set", "forbid.collision=true"}), 8) << complained();
  const nlohmann::json written = summary();
  EXPECT_EQ(written.at("status"), "failed");
  EXPECT_LT(written.at("simulated_time_s").get<double>(), 5);
  const nlohmann::json event = written.at("forbidden_event");
  EXPECT_EQ(event.at("event"), "collision");
  EXPECT_NE(event.at("reason").get<std::string>().find("touches 'wall' (b)"), std::string::npos)
      << event;
  EXPECT_NEAR(event.at("time_s").get<double>(), written.at("simulated_time_s").get<double>(), 1e-9);
  const std::string line = "forbidden event collision: 'robot' (";
  EXPECT_EQ(written.at("message").get<std::string>().rfind(line, 0), 0u) << written.at("message");
  EXPECT_NE(said().find("failed: " + line), std::string::npos) << said();
  EXPECT_NE(said().find("results: "), std::string::npos) << said();
  // Its state can be examined, and continued by a scene that forbids nothing.
  EXPECT_EQ(ProgramRun::run({"run", path, "--no-render", "--resume", out() + "/failed.snapshot",
                             "--duration", "6", "--out", out() + "2"}),
            0)
      << complained();
}

}  // namespace
}  // namespace navvy
