// SPDX-License-Identifier: Apache-2.0
// Every scene of scenarios/ runs to its stated end: exit status 0, all programs done, no mass lost.
// Its cameras show all machines until then.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "control/step_kinds.h"
#include "folder.h"
#include "paths.h"
#include "process.h"
#include "run/simulation.h"
#include "scene_io/loader.h"
#include "sim/camera_framing.h"
#include "sim/frame_builder.h"
#include "sim/occupied_areas.h"
#include "text_of.h"

namespace navvy {
namespace {

namespace fs = std::filesystem;

/// Returns the files of all shipped scenes, relative to scenarios/, in alphabetical order.
std::vector<std::string> shipped_scenes() {
  const fs::path root = fs::path(source_dir()) / "scenarios";
  std::vector<std::string> out;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root))
    if (entry.path().extension() == ".sdf")
      out.push_back(fs::relative(entry.path(), root).generic_string());
  std::sort(out.begin(), out.end());
  return out;
}

class ShippedScene : public testing::TestWithParam<std::string> {};

TEST_P(ShippedScene, RunsToItsStatedEnd) {
  const test::Folder folder;
  test::Command command{NAVVY_PROGRAM,
                        {"run", source_dir() + "/scenarios/" + GetParam(), "--no-render", "--quiet",
                         "--out", folder / "out"},
                        {}};
  command.err = folder / "err";
  EXPECT_EQ(test::wait_for(test::start(command)), 0) << test::text_of(command.err);
  const auto summary = nlohmann::json::parse(test::text_of(folder / "out/summary.json"));
  EXPECT_EQ(summary.at("status"), "finished");
  for (const auto& program : summary.at("programs"))
    EXPECT_EQ(program.at("state"), "done") << program.dump(1);
  EXPECT_EQ(summary.at("mass_ledger").at("error_units"), 0);
}

/// Watches how much of the pictures machines take during a run.
class Coverage {
 public:
  explicit Coverage(const sim::World& world) : world_(world), framing_(world), builder_(world) {}

  /// Compares all machines with all cameras that are fixed or follow a machine.
  void observe() {
    const scene::Scene& scene = world_.description();
    for (const scene::MachineInWorld& placed : scene.machines) {
      if (!sim::is_machine(placed)) continue;
      scene::Camera around;
      around.frame = scene::Camera::Framed::kMachine;
      around.machine = placed.name;
      const std::vector<Vec3> points = framing_.points(around);
      bool seen = false;
      double share = 0;
      for (const scene::Camera& camera : scene.cameras) {
        if (camera.kind == scene::Camera::Kind::kOnLink || camera.name == kUnused) continue;
        const Vec2 range = columns(builder_.camera(camera), points);
        if (!(range.x() < range.y())) continue;
        seen = true;
        share = std::max(share, range.y() - range.x());
      }
      if (!seen)
        ADD_FAILURE() << placed.name << " leaves all pictures at " << world_.time() << " s";
      least_[placed.name] = std::min(least_.try_emplace(placed.name, 1).first->second, share);
    }
  }
  /// Returns for each machine the least share of the width of the camera's picture that shows it
  /// largest.
  const std::map<std::string, double>& least() const { return least_; }

  /// Name of a camera for the scene that frames machines, so that their sizes are read.
  static constexpr const char* kUnused = "unused";

 private:
  /// Returns the shares of the width at which points begin and end; nothing if one is outside.
  static Vec2 columns(const scene::FrameCamera& camera, const std::vector<Vec3>& points) {
    const double scale = 0.5 / std::tan(0.5 * camera.fov),
                 tall = 1.0 * camera.height / camera.width;
    Vec2 range(1, 0);
    for (const Vec3& p : points) {
      const Vec3 c = camera.X_WC.inverse() * p;
      const double x = 0.5 + scale * c.x() / -c.z(), y = 0.5 * tall + scale * c.y() / -c.z();
      if (c.z() > -0.1 || x < 0 || x > 1 || y < 0 || y > tall) return {1, 0};
      range = {std::min(range.x(), x), std::max(range.y(), x)};
    }
    return range;
  }

  const sim::World& world_;
  sim::CameraFraming framing_;
  sim::FrameBuilder builder_;
  std::map<std::string, double> least_;
};

TEST_P(ShippedScene, ShowsEachMachineToItsEnd) {
  scene::Scene scene =
      scene_io::load_scene(source_dir() + "/scenarios/" + GetParam(), control::step_kinds());
  scene::Camera unused;
  unused.name = Coverage::kUnused;
  unused.frame = scene::Camera::Framed::kMachine;
  scene.cameras.push_back(unused);
  run::Simulation simulation(std::move(scene));
  Coverage coverage(simulation.world());
  coverage.observe();
  double next = 1;
  run::LoopHooks hooks;
  hooks.progress = [&](const run::RunProgress& progress) {
    if (progress.time < next || HasFailure()) return;
    next += 1;
    coverage.observe();
  };
  simulation.run_to_end(hooks);
  for (const auto& [machine, share] : coverage.least()) {
    std::printf("%s: %.0f %% of the width\n", machine.c_str(), 100 * share);
    if (GetParam().rfind("paper/", 0) == 0) EXPECT_GE(share, 0.25) << machine;
  }
}

INSTANTIATE_TEST_SUITE_P(All, ShippedScene, testing::ValuesIn(shipped_scenes()),
                         [](const testing::TestParamInfo<std::string>& test) {
                           std::string name = fs::path(test.param).replace_extension().string();
                           std::replace_if(
                               name.begin(), name.end(),
                               [](unsigned char c) { return !std::isalnum(c); }, '_');
                           return name;
                         });

}  // namespace
}  // namespace navvy
