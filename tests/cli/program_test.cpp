// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "cli/program_run.h"
#include "cli/telemetry_table.h"
#include "core/random.h"

namespace navvy {
namespace {

namespace fs = std::filesystem;

using test::text_of;

class Program : public test::ProgramRun {
 protected:
  static std::string scene(const std::string& name) {
    return navvy::source_dir() + "/scenarios/" + name;
  }
};

/// Expects every file of a run, if it exists, to be complete; if the run was killed, the last row
/// of telemetry may lack its line end.
void expect_readable(const std::string& out, bool killed = false) {
  const fs::path summary = fs::path(out) / "summary.json",
                 telemetry = fs::path(out) / "telemetry.csv";
  if (fs::exists(summary)) EXPECT_TRUE(nlohmann::json::accept(text_of(summary))) << summary;
  if (fs::exists(telemetry)) {
    std::string text = text_of(telemetry);
    ASSERT_FALSE(text.empty());
    if (!killed) EXPECT_EQ(text.back(), '\n');
    // Readers ignore a line without a line end.
    text.erase(text.rfind('\n') + 1);
    ASSERT_FALSE(text.empty());
    std::istringstream lines(text);
    std::string line;
    std::getline(lines, line);
    const auto columns = std::count(line.begin(), line.end(), ',');
    while (std::getline(lines, line)) EXPECT_EQ(std::count(line.begin(), line.end(), ','), columns);
  }
  for (const char* name : {"terrain_start.tif", "terrain_end.tif"}) {
    const fs::path path = fs::path(out) / name;
    // Little-endian TIFF
    if (fs::exists(path)) EXPECT_EQ(text_of(path).substr(0, 2), "II") << path;
  }
  const fs::path frames = fs::path(out) / "frames";
  if (!fs::exists(frames)) return;
  for (const auto& frame : fs::directory_iterator(frames)) {
    if (frame.path().extension() != ".png") continue;
    const std::string bytes = text_of(frame.path());
    const std::string end("IEND\xAE\x42\x60\x82", 8);  // last chunk of a PNG
    EXPECT_TRUE(bytes.size() > end.size() &&
                bytes.compare(bytes.size() - end.size(), end.size(), end) == 0)
        << frame.path();
  }
}

TEST_F(Program, LeavesAllResultsAndClosesTheLedger) {
  ASSERT_EQ(
      run({"run", scene("bucket_path.sdf"), "--no-render", "--duration", "0.3", "--out", out()}), 0)
      << complained();
  const auto summary = nlohmann::json::parse(text_of(out() + "/summary.json"));
  // The path lasts 13 s. A shorter duration ends with status 0 and a report of the missing part.
  EXPECT_EQ(summary.at("status"), "incomplete");
  const nlohmann::json program = summary.at("programs").at(0);
  EXPECT_EQ(program.at("machine"), "bucket");
  EXPECT_EQ(program.at("step"), 1);
  EXPECT_EQ(program.at("state"), "out_of_time");
  EXPECT_NE(program.at("reason").get<std::string>().find("0.3 s"), std::string::npos) << program;
  EXPECT_NE(said().find("incomplete: 'bucket', step 1 of 1 (trajectory): out_of_time"),
            std::string::npos)
      << said();
  EXPECT_EQ(summary.at("mass_ledger").at("error_units"), 0);
  for (const char* key :
       {"schema_version", "device", "steps", "wall_time_s", "simulated_time_s", "real_time_factor",
        "time_share", "cycles", "bank_volume_m3", "loose_volume_m3", "payload_kg", "energy_j",
        "bucket_force_peak_n", "bucket_force_mean_n", "particles_peak", "state_hash"})
    EXPECT_TRUE(summary.contains(key)) << key;
  const std::string documented = text_of(navvy::source_dir() + "/docs/reference/results.md");
  for (const auto& [key, value] : summary.items())
    EXPECT_NE(documented.find("`" + key), std::string::npos)
        << key << " is not in docs/reference/results.md";
  for (const char* name : {"telemetry.csv", "terrain_start.tif", "terrain_end.tif", "scene.sdf",
                           "run.json", "replay.jsonl", "report.html"})
    EXPECT_TRUE(fs::exists(fs::path(out()) / name)) << name;
  expect_readable(out());
  test::expect_same_table(out(), 1);
}

TEST_F(Program, RepeatsARunFromTheSceneInItsFolder) {
  // Uses every option that changes a scene; 1.3 s reach into the soil.
  ASSERT_EQ(run({"run", scene("bucket_path.sdf"), "--no-render", "--duration", "1.3", "--seed", "9",
                 "--size", "8.4,5.2", "--set", "soil.cohesion_pa=8000", "--set",
                 "machine[bucket].x_m=0.05", "--out", out()}),
            0)
      << complained();
  const auto first = nlohmann::json::parse(text_of(out() + "/summary.json"));
  const auto info = nlohmann::json::parse(text_of(out() + "/run.json"));
  EXPECT_EQ(info.at("format"), 1);
  EXPECT_EQ(info.at("command").at(1), "run");
  EXPECT_EQ(info.at("command").back(), out());
  EXPECT_FALSE(info.at("navvy").get<std::string>().empty());
  // From another place and without options.
  const std::string moved = (directory_ / "moved.sdf").string();
  fs::copy_file(out() + "/scene.sdf", moved);
  // The duration that the command line set before now comes from the scene: the run counts as
  // incomplete.
  ASSERT_EQ(run({"run", moved, "--out", out() + "2"}), 6) << complained();
  const auto again = nlohmann::json::parse(text_of(out() + "2/summary.json"));
  EXPECT_GT(again.at("particles_peak").get<int>(), 0) << "it never reached the soil";
  EXPECT_EQ(again.at("steps"), first.at("steps"));
  EXPECT_EQ(again.at("state_hash"), first.at("state_hash"));
  for (const char* name : {"/telemetry.csv", "/telemetry.npy"})
    EXPECT_EQ(text_of(out() + "2" + name), text_of(out() + name)) << name;
  EXPECT_EQ(text_of(out() + "2/scene.sdf"), text_of(out() + "/scene.sdf"));
}

TEST_F(Program, KeepsAnEarlierRunAsPrevious) {
  const std::vector<std::string> arguments{
      "run", scene("bucket_path.sdf"), "--no-render", "--duration", "0.05", "--out", out()};
  ASSERT_EQ(run(arguments), 0);
  ASSERT_EQ(run(arguments), 0);
  EXPECT_TRUE(fs::exists(out() + ".previous/summary.json"));
  EXPECT_TRUE(fs::exists(out() + "/summary.json"));
}

TEST_F(Program, ReportsBadInputByStatusAndMessage) {
  EXPECT_EQ(run({"run", "no_such_scene.sdf"}), 2);
  EXPECT_NE(complained().find("no_such_scene.sdf"), std::string::npos) << complained();
  EXPECT_EQ(run({"run", scene("trench.sdf"), "--set", "solver.cell_m=0"}), 2);
  EXPECT_NE(complained().find("cell_m"), std::string::npos) << complained();
  EXPECT_EQ(run({"run", scene("trench.sdf"), "--set", "soil.cohesion_pa=nan"}), 2);
  EXPECT_EQ(run({"run", scene("trench.sdf"), "--set", "soil.kohesion_pa=1"}), 2);
  EXPECT_NE(complained().find("cohesion_pa"), std::string::npos) << complained();
  EXPECT_EQ(run({"run", scene("trench.sdf"), "--set", "soil.bank_density_kg_per_m3=0"}), 2);
  EXPECT_NE(complained().find("bank_density"), std::string::npos) << complained();
  EXPECT_EQ(run({"run", scene("trench.sdf"), "--at", "here"}), 2);
  EXPECT_EQ(run({"run"}), 2);
  EXPECT_EQ(run({"run", scene("bucket_path.sdf"), "--device", "no such device", "--out", out()}),
            3);
  EXPECT_NE(complained().find("no such device"), std::string::npos) << complained();
}

// Faults that the table of scene_io (broken_scenes.txt) cannot hold, because they need the ground
// and the machine on it: every broken/NAME.sdf is refused with all lines of broken/NAME.txt.
TEST_F(Program, CheckRefusesTheScenesThatARunRefuses) {
  int files = 0;
  for (const auto& entry : fs::directory_iterator(navvy::source_dir() + "/tests/cli/broken")) {
    if (entry.path().extension() != ".sdf") continue;
    ++files;
    EXPECT_EQ(run({"check", entry.path().string()}), 2) << entry.path();
    std::istringstream expected(text_of(fs::path(entry.path()).replace_extension(".txt")));
    for (std::string fragment; std::getline(expected, fragment);)
      EXPECT_NE(said().find(fragment), std::string::npos) << "'" << fragment << "' not found in:\n"
                                                          << said();
  }
  EXPECT_GE(files, 2);
  const std::string unreachable = navvy::source_dir() + "/tests/cli/broken/dig_out_of_reach.sdf";
  run({"check", unreachable});
  const std::string checked = said();
  EXPECT_EQ(run({"run", unreachable, "--no-render", "--quiet", "--out", out()}), 2);
  // `check` also reports how the machine stands.
  EXPECT_NE(checked.find(complained()), std::string::npos) << "check:\n"
                                                           << checked << "run:\n"
                                                           << complained();
}

TEST_F(Program, ReportsBadFilesAndNumbersInOneLineBeforeTheRun) {
  EXPECT_EQ(run({"run", scene("bucket_path.sdf"), "--resume", "no_such.snapshot", "--out", out()}),
            2);
  EXPECT_NE(complained().find("--resume: 'no_such.snapshot': no such snapshot"), std::string::npos)
      << complained();
  EXPECT_EQ(run({"run", scene("trench.sdf"), "--terrain", "no_such.tif"}), 2);
  EXPECT_NE(complained().find("on the command line paths count from this directory"),
            std::string::npos)
      << complained();
  for (const char* value : {"0", "-1", "nan", "inf"}) {
    EXPECT_EQ(run({"lab", "rest", "--cell", value}), 2) << value;
    EXPECT_NE(complained().find("must be a number above 0"), std::string::npos) << complained();
    EXPECT_LT(complained().size(), 200u) << complained();
  }
  EXPECT_EQ(run({"lab", "rest", "--phi-deg", "75"}), 2);
  EXPECT_NE(complained().find("/friction_angle_deg: '75': must be a number from 0 to 50"),
            std::string::npos)
      << complained();
  EXPECT_EQ(run({"lab", "rest", "--triaxial-deg", "30", "--repose-deg", "28"}), 2);
  EXPECT_NE(complained().find("the friction angle is given already by --triaxial-deg"),
            std::string::npos)
      << complained();
  EXPECT_EQ(run({"lab", "rest", "--set", "friction_angle_deg.triax=30"}), 2);
  EXPECT_NE(complained().find("did you mean 'triaxial'?"), std::string::npos) << complained();
  EXPECT_EQ(run({"lab", "rest", "--direct-shear-deg", "40"}), 2);
  EXPECT_NE(complained().find("'40': is above the limit of 50 deg in plane strain"),
            std::string::npos)
      << complained();
  // A path that cannot be written is refused before the experiment starts, so that no hours are
  // lost.
  const std::string impossible = (directory_ / "stdin" / "rest.json").string();
  EXPECT_EQ(run({"lab", "column", "--json", impossible}), 4) << complained();
  EXPECT_NE(complained().find(impossible), std::string::npos) << complained();
  EXPECT_EQ(said(), "") << "the rig ran";
}

TEST_F(Program, LabHasItsOwnExitStatusForResultsOutsideTolerance) {
  // Measured while it settles, the plate is neither at rest nor on the soil.
  const std::string json = (directory_ / "light.json").string();
  ASSERT_EQ(
      run({"lab", "light-tool", "--height", "0.2", "--time", "0.4", "--quiet", "--json", json}), 7)
      << complained();
  EXPECT_NE(said().find("  outside"), std::string::npos) << said();
  EXPECT_EQ(nlohmann::json::parse(text_of(json)).at("outside_tolerance").size(), 2u);
}

TEST_F(Program, LabAppliesNoToleranceToOtherSetups) {
  // A plane less steep than the soil's friction on it: nothing slides, so there is no acceleration
  // to compare.
  const std::string json = (directory_ / "slide.json").string();
  run({"lab", "slide", "--tilt-deg", "10", "--time", "0.1", "--quiet", "--json", json});
  const auto result = nlohmann::json::parse(text_of(json));
  for (const char* name : {"soil_block__acceleration_m_s2", "rigid_plate__acceleration_m_s2"}) {
    EXPECT_TRUE(result.at("not_judged").contains(name)) << result.dump(1);
    EXPECT_FALSE(result.contains("outside_tolerance") &&
                 result.at("outside_tolerance").dump().find(name) != std::string::npos);
  }
  EXPECT_NE(said().find(
                "not judged: soil block, acceleration; its tolerance applies to a plane so steep"),
            std::string::npos)
      << said();
}

TEST_F(Program, LabWritesEveryNumberOfItsSoil) {
  const std::string json = (directory_ / "light.json").string();
  ASSERT_EQ(run({"lab", "light-tool", "--delta-deg", "12", "--set", "opening_strain=0.02", "--set",
                 "friction_angle_deg=31", "--quiet", "--json", json}),
            0)
      << complained();
  const auto soil = nlohmann::json::parse(text_of(json)).at("inputs").at("soil");
  EXPECT_NEAR(soil.at("tool_friction_angle_deg").get<double>(), 12, 1e-9);
  EXPECT_NEAR(soil.at("opening_strain").get<double>(), 0.02, 1e-12);
  EXPECT_NEAR(soil.at("friction_angle_deg").get<double>(), 31, 1e-9);
  for (const char* name :
       {"name", "bank_density_kg_per_m3", "swell", "friction_angle_deg", "cohesion_pa",
        "residual_cohesion_pa", "remoulding_strain", "loosening_strain", "opening_strain",
        "young_modulus_pa", "poisson", "adhesion_pa", "bekker_n", "janosi_k_m"})
    EXPECT_TRUE(soil.contains(name)) << name;
}

TEST_F(Program, LabHelpFollowsFromTheRigAndFitsATerminal) {
  ASSERT_EQ(run({"lab", "blade", "--help"}), 0) << complained();
  const std::string help = said();
  for (const char* part : {"--plane yes|no=yes", "15 .. 150", "navvy lab blade --plane no"})
    EXPECT_NE(help.find(part), std::string::npos) << part << "\n" << help;
  std::istringstream lines(help);
  for (std::string line; std::getline(lines, line);)
    if (line.rfind("Usage", 0) != 0) {  // the parser's own line, with the program's path
      EXPECT_LE(line.size(), 100u) << line;
    }
}

TEST_F(Program, LabRunsEveryCombinationOfListsAndDrawsThem) {
  const std::string json = (directory_ / "sweep.json").string(),
                    svg = (directory_ / "sweep.svg").string();
  ASSERT_EQ(run({"lab", "light-tool", "--height", "0.01,0.02", "--cohesion-pa", "0,20000",
                 "--quiet", "--json", json, "--plot", svg}),
            0)
      << complained();
  const auto runs = nlohmann::json::parse(text_of(json));
  ASSERT_EQ(runs.size(), 4u);
  const auto& last = runs.at(3).at("inputs");
  EXPECT_EQ(last.at("geometry").at("height_m").get<double>(), 0.02);
  EXPECT_EQ(last.at("soil").at("young_modulus_pa").get<double>(), 4e6)
      << "stiffness follows the cohesion";
  EXPECT_EQ(runs.at(0).at("inputs").at("soil").at("young_modulus_pa").get<double>(), 1e6);
  EXPECT_NE(text_of(svg).find("height [m]"), std::string::npos);
  EXPECT_EQ(run({"lab", "light-tool", "--plot", svg}), 2);
  EXPECT_NE(complained().find("drawn over a list of values"), std::string::npos) << complained();
}

TEST_F(Program, LabNamesAWrongArgumentOfTheRig) {
  EXPECT_EQ(run({"lab", "column", "--shape", "plain"}), 2);
  EXPECT_NE(complained().find("did you mean 'plane'?"), std::string::npos) << complained();
  EXPECT_EQ(run({"lab", "cycle", "--cycles", "2.5"}), 2);
  EXPECT_NE(complained().find("lab cycle --cycles: '2.5': a whole number, at least 1"),
            std::string::npos)
      << complained();
}

TEST_F(Program, LabNamesAWrongNumberOfTheSoil) {
  EXPECT_EQ(run({"lab", "light-tool", "--set", "opening_stain=0.02"}), 2);
  EXPECT_NE(complained().find("'opening_strain'"), std::string::npos) << complained();
  EXPECT_EQ(run({"lab", "light-tool", "--set", "opening_strain=much"}), 2);
  EXPECT_NE(complained().find("much"), std::string::npos) << complained();
  EXPECT_EQ(run({"lab", "light-tool", "--set", "opening_strain=7"}), 2);
  EXPECT_NE(complained().find("opening_strain"), std::string::npos) << complained();
}

TEST_F(Program, ReportsAFolderThatItCannotWriteTo) {
  // A directory below a file cannot be created. (Tests of core cover the full disk: PoCL's own
  // cache would fail first here.)
  const std::string impossible = (directory_ / "stdin" / "out").string();
  EXPECT_EQ(run({"run", scene("bucket_path.sdf"), "--no-render", "--duration", "0.1", "--out",
                 impossible}),
            4)
      << complained();
  EXPECT_NE(complained().find(impossible), std::string::npos) << complained();
}

TEST_F(Program, StopsCleanlyAtCtrlC) {
  const pid_t child = start({"run", scene("bucket_path.sdf"), "--no-render", "--out", out()});
  for (int i = 0; i < 600 && !fs::exists(out() + "/summary.json"); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  kill(child, SIGINT);
  EXPECT_EQ(test::wait_for(child), 130) << complained();
  EXPECT_EQ(nlohmann::json::parse(text_of(out() + "/summary.json")).at("status"), "interrupted");
  EXPECT_TRUE(fs::exists(out() + "/terrain_end.tif"));
  expect_readable(out());
}

TEST_F(Program, StopsAtCtrlCWhileItWaitsForAControlLine) {
  // A controller that never answers: a pipe that nobody writes to and nobody closes.
  const std::string pipe = (directory_ / "pipe").string();
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const int held = open(pipe.c_str(), O_RDWR);
  ASSERT_GE(held, 0);
  const pid_t child = test::start(
      {NAVVY_PROGRAM,
       {"run", scene("bucket_path.sdf"), "--no-render", "--control", "stdio", "--out", out()},
       environment_,
       pipe,
       (directory_ / "stdout").string(),
       (directory_ / "stderr").string()});
  for (int i = 0; i < 600 && said().empty(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  ASSERT_FALSE(said().empty());
  kill(child, SIGINT);
  EXPECT_EQ(test::wait_for(child), 130) << complained();
  close(held);
  EXPECT_EQ(nlohmann::json::parse(text_of(out() + "/summary.json")).at("status"), "interrupted");
}

TEST_F(Program, TakesAnOutputFolderWithASlashAtItsEnd) {
  for (int i = 0; i < 2; ++i)
    EXPECT_EQ(run({"run", scene("bucket_path.sdf"), "--no-render", "--duration", "0.02", "--out",
                   out() + "/"}),
              0)
        << complained();
  EXPECT_TRUE(fs::exists(out() + "/summary.json"));
  EXPECT_TRUE(fs::exists(out() + ".previous/summary.json"));
}

TEST_F(Program, CheckAcceptsTheOverridesOfARun) {
  EXPECT_EQ(run({"check", scene("trench.sdf"), "--set", "soil.cohesion_pa=9000"}), 0) << said();
  EXPECT_EQ(run({"check", scene("trench.sdf"), "--set", "soil.cohesion_pa=-1"}), 2);
  EXPECT_NE(said().find("cohesion_pa"), std::string::npos) << said();
  EXPECT_EQ(run({"check", scene("trench.sdf"), "--seed", "-3"}), 2);
  EXPECT_EQ(run({"run", "trensh"}), 2);
  EXPECT_NE(complained().find("did you mean 'trench'?"), std::string::npos) << complained();
  EXPECT_EQ(run({"bogus"}), 2);
  EXPECT_NE(complained().find("'bogus'"), std::string::npos) << complained();
}

TEST_F(Program, LeavesReadableFilesWhereverItIsKilled) {
  Random random(7);
  int with_results = 0, with_pictures = 0;
  const std::vector<std::string> drawing{"--set", "camera.rate_hz=50"};
  // Time until pictures are drawn on this machine: kills are spread over twice that time.
  const auto begun = std::chrono::steady_clock::now();
  std::vector<std::string> first{"run", scene("bucket_path.sdf"), "--out", out()};
  first.insert(first.end(), drawing.begin(), drawing.end());
  const pid_t probe = start(first);
  for (int i = 0; i < 4000 && !(fs::exists(out() + "/frames") && !fs::is_empty(out() + "/frames"));
       ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  const double start_up =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begun).count();
  kill(probe, SIGKILL);
  test::wait_for(probe);
  for (int i = 0; i < 20; ++i) {
    fs::remove_all(out());
    fs::remove_all(out() + ".previous");
    // Every other run draws pictures continuously.
    std::vector<std::string> arguments{"run", scene("bucket_path.sdf"), "--out", out()};
    if (i % 2 == 0)
      arguments.push_back("--no-render");
    else
      arguments.insert(arguments.end(), drawing.begin(), drawing.end());
    const pid_t child = start(arguments);
    std::this_thread::sleep_for(
        std::chrono::milliseconds(static_cast<int>(random.uniform(0.1, 2) * start_up)));
    kill(child, SIGKILL);
    test::wait_for(child);
    expect_readable(out(), true);
    with_results += fs::exists(out() + "/summary.json") ? 1 : 0;
    with_pictures += fs::exists(out() + "/frames") && !fs::is_empty(out() + "/frames") ? 1 : 0;
  }
  EXPECT_GT(with_results, 0) << "every kill came before the first file";
  EXPECT_GT(with_pictures, 0) << "every kill came before the first picture";
}

TEST_F(Program, IsDrivenOverStandardInputInLockStep) {
  std::string lines;
  for (int i = 0; i < 10; ++i)
    lines += R"({"inputs": {"bucket/slide_x/velocity": 0.5}})"
             "\n";
  lines += R"({"end": true})";  // the last line may lack its end
  ASSERT_EQ(
      run({"run", scene("bucket_path.sdf"), "--no-render", "--control", "stdio", "--out", out()},
          lines),
      0)
      << complained();
  std::istringstream said_lines(said());
  std::string line;
  int count = 0;
  double time = -1;
  while (std::getline(said_lines, line)) {
    const auto state = nlohmann::json::parse(line);
    EXPECT_GT(state.at("time").get<double>(), time);
    time = state.at("time").get<double>();
    EXPECT_NEAR(state.at("outputs").at("bucket/slide_x/position").get<double>(), -1.6 + 0.5 * time,
                1e-6)
        << "driven by inputs, not by its program";
    ++count;
  }
  EXPECT_EQ(count, 11);  // ten answered, one ended
  EXPECT_NEAR(time, 10 / 50.0, 1e-9);
}

TEST_F(Program, IsDrivenAtTheRequestedRate) {
  // None of these periods is a whole number of the scene's own steps.
  for (const int rate : {500, 20, 7, 1000}) {
    const int exchanges = rate < 100 ? 2 : 8;
    std::string lines;
    for (int i = 1; i < exchanges; ++i) lines += "{}\n";
    ASSERT_EQ(run({"run", scene("bucket_path.sdf"), "--no-render", "--control", "stdio",
                   "--control-rate", std::to_string(rate), "--out", out()},
                  lines + "{\"end\": true}\n"),
              0)
        << complained();
    std::istringstream said_lines(said());
    std::string line;
    int n = 0;
    for (; std::getline(said_lines, line); ++n)
      EXPECT_NEAR(nlohmann::json::parse(line).at("time").get<double>(),
                  n / static_cast<double>(rate), 1e-9)
          << rate;
    EXPECT_EQ(n, exchanges) << rate;
    EXPECT_NE(complained().find("a whole number of base steps makes up a control step"),
              std::string::npos)
        << complained();
    // The control step is part of what reproduces the run.
    EXPECT_NE(text_of(out() + "/scene.sdf").find("control_rate_hz"), std::string::npos);
  }
  EXPECT_EQ(run({"run", scene("bucket_path.sdf"), "--control", "stdio", "--control-rate", "0",
                 "--out", out()}),
            2);
}

TEST_F(Program, SaysThatTheSceneLimitsItsStep) {
  ASSERT_EQ(run({"run", scene("bucket_path.sdf"), "--no-render", "--duration", "0.02", "--set",
                 "solver.max_step_s=0.001", "--out", out()}),
            0)
      << complained();
  EXPECT_NE(complained().find("max_step_s of the solver allows no longer ones"), std::string::npos)
      << complained();
}

/// Results depend on the control rate only through the base step: a controller that answers every
/// exchange and sets nothing gets the run that the scene makes by itself at the same rate.
TEST_F(Program, IsTheSameWithoutAControllerWhenTheSceneSetsTheRate) {
  const std::vector<std::string> common = {
      "run", scene("bucket_path.sdf"), "--no-render", "--duration", "0.5", "--hash-every", "0.1"};
  const auto hashes = [&](const std::string& out, std::vector<std::string> more,
                          const std::string& input) {
    more.insert(more.begin(), common.begin(), common.end());
    more.insert(more.end(), {"--out", out});
    EXPECT_EQ(run(more, input), 0) << complained();
    return text_of(out + "/hashes.csv");
  };
  std::string lines;
  for (int i = 0; i < 100; ++i) lines += "{}\n";
  const std::string driven = hashes(out(), {"--control", "stdio", "--control-rate", "70"}, lines);
  const std::string alone = hashes(out() + "2", {"--set", "solver.control_rate_hz=70"}, "");
  EXPECT_GE(std::count(driven.begin(), driven.end(), '\n'), 5);
  EXPECT_EQ(driven, alone);
  // Without the rate, results differ.
  EXPECT_NE(hashes(out() + "3", {}, ""), alone);
}

TEST_F(Program, ResumesFromASnapshotToTheSameEnd) {
  const std::string snapshot = (directory_ / "middle.snapshot").string();
  ASSERT_EQ(run({"run", scene("bucket_path.sdf"), "--no-render", "--duration", "1.5", "--out",
                 out(), "--snapshot", snapshot, "--snapshot-at", "1.2"}),
            0)
      << complained();
  const auto whole = nlohmann::json::parse(text_of(out() + "/summary.json"));
  ASSERT_EQ(run({"run", scene("bucket_path.sdf"), "--no-render", "--duration", "1.5", "--out",
                 out() + "2", "--resume", snapshot}),
            0)
      << complained();
  const auto resumed = nlohmann::json::parse(text_of(out() + "2/summary.json"));
  EXPECT_EQ(resumed.at("steps"), whole.at("steps"));
  EXPECT_EQ(resumed.at("state_hash"), whole.at("state_hash"));
  EXPECT_NE(complained().find("telemetry (100 Hz) takes the nearest step"), std::string::npos)
      << complained();
  // Its telemetry begins with the state of the snapshot and continues with the rows of the whole
  // run, byte for byte.
  const std::string all = text_of(out() + "/telemetry.csv"),
                    later = text_of(out() + "2/telemetry.csv");
  const std::string header = all.substr(0, all.find('\n') + 1);
  ASSERT_EQ(later.substr(0, header.size()), header);
  EXPECT_NEAR(std::stod(later.substr(header.size())), 1.2, 0.002);
  const std::string rows = later.substr(later.find('\n', header.size()) + 1);
  EXPECT_GE(std::count(rows.begin(), rows.end(), '\n'), 14);
  ASSERT_GT(all.size(), rows.size());
  EXPECT_EQ(all.substr(all.size() - rows.size()), rows);
}

TEST_F(Program, StopsOnAFullDeviceAndLeavesASnapshotThatResumes) {
  environment_ = {{"NAVVY_DEVICE_MEMORY_MIB", "9"}};
  ASSERT_EQ(
      run({"run", scene("bucket_path.sdf"), "--no-render", "--duration", "4", "--out", out()}), 3)
      << complained();
  EXPECT_NE(complained().find("soil step"), std::string::npos) << complained();
  EXPECT_NE(complained().find("bytes are in use"), std::string::npos) << complained();
  const auto failed = nlohmann::json::parse(text_of(out() + "/summary.json"));
  EXPECT_EQ(failed.at("status"), "failed");
  EXPECT_GT(failed.at("simulated_time_s").get<double>(), 0.5) << "it dug before memory ran out";
  EXPECT_EQ(failed.at("mass_ledger").at("error_units"), 0);
  environment_.clear();
  const double time = failed.at("simulated_time_s").get<double>() + 0.1;
  ASSERT_EQ(run({"run", scene("bucket_path.sdf"), "--no-render", "--duration", std::to_string(time),
                 "--out", out() + "2", "--resume", out() + "/failed.snapshot"}),
            0)
      << complained();
  const auto resumed = nlohmann::json::parse(text_of(out() + "2/summary.json"));
  EXPECT_EQ(resumed.at("mass_ledger").at("error_units"), 0);
  EXPECT_GT(resumed.at("steps").get<int>(), failed.at("steps").get<int>());
}

TEST_F(Program, StopsOnAToolFasterThanWavesAndLeavesASnapshotThatResumes) {
  const std::string middle = (directory_ / "middle.snapshot").string();
  ASSERT_EQ(run({"run", scene("bucket_path.sdf"), "--no-render", "--duration", "2", "--out", out(),
                 "--snapshot", middle, "--snapshot-at", "1.9"}),
            0)
      << complained();
  // Continue with manual inputs: slowly, then at 60 m/s through the soil.
  const auto drive = [&](const std::string& snapshot, const std::string& to,
                         const std::vector<int>& speeds) {
    std::string lines;
    for (const int speed : speeds)
      lines += R"({"inputs": {"bucket/slide_x/velocity": )" + std::to_string(speed) + "}}\n";
    lines += "{\"end\": true}\n";
    return run({"run", scene("bucket_path.sdf"), "--no-render", "--control", "stdio", "--resume",
                snapshot, "--out", to},
               lines);
  };
  ASSERT_EQ(drive(middle, out() + "1", {0, 0, 60, 60}), 5) << complained();
  EXPECT_NE(complained().find("soil step"), std::string::npos) << complained();
  EXPECT_NE(complained().find("faster than waves"), std::string::npos) << complained();
  const auto failed = nlohmann::json::parse(text_of(out() + "1/summary.json"));
  EXPECT_EQ(failed.at("status"), "failed");
  EXPECT_NE(failed.at("message").get<std::string>().find("m/s"), std::string::npos);
  EXPECT_EQ(failed.at("mass_ledger").at("error_units"), 0);
  expect_readable(out() + "1");
  ASSERT_EQ(drive(out() + "1/failed.snapshot", out() + "2", {0, 0}), 0) << complained();
  EXPECT_EQ(
      nlohmann::json::parse(text_of(out() + "2/summary.json")).at("mass_ledger").at("error_units"),
      0);
}

TEST_F(Program, ListsDevicesSoilsAndChannels) {
  EXPECT_EQ(run({"devices"}), 0);
  EXPECT_NE(said().find("0: "), std::string::npos);
  EXPECT_EQ(run({"soils"}), 0);
  EXPECT_NE(said().find("loam"), std::string::npos);
  EXPECT_EQ(run({"channels", scene("trench.sdf")}), 0);
  EXPECT_NE(said().find("excavator/boom_joint/position"), std::string::npos);
  EXPECT_EQ(run({"check", scene("trench.sdf")}), 0);
}

}  // namespace
}  // namespace navvy
