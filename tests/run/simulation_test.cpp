// SPDX-License-Identifier: Apache-2.0
#include "run/simulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "core/error.h"
#include "folder.h"
#include "formats/particle_files.h"
#include "render/image.h"
#include "run/scene.h"
#include "sim/read_particles.h"
#include "text_of.h"

namespace navvy::run {
namespace {

using nlohmann::json;
using test::bucket_scene;
using test::with_height_grid;

json json_of(const std::string& path) { return json::parse(navvy::test::text_of(path)); }

/// Lowers the bucket into the ground, so that soil becomes active.
void dig(Simulation& simulation, int steps) {
  simulation.set("bucket/slide_z/velocity", -1);
  simulation.step(steps);
}

TEST(Simulation, StepsSetsAndReadsWithoutAnOutputFolder) {
  Simulation simulation(bucket_scene(2));
  EXPECT_EQ(simulation.time(), 0);
  const int height = simulation.output("bucket/slide_z/position");
  const double before = simulation.get(height);
  simulation.set(simulation.input("bucket/slide_z/velocity"), -0.2);
  simulation.step(100);
  EXPECT_LT(simulation.get(height), before - 0.01);
  EXPECT_DOUBLE_EQ(simulation.time(), 100 * simulation.world().dt());
  EXPECT_THROW(simulation.input("bucket/slyde_z/velocity"), InputError);
  const json summary = json::parse(simulation.summary());
  EXPECT_EQ(summary.at("scenario"), "bucket_path");
  EXPECT_EQ(summary.at("state_hash"), simulation.state_hash());
  EXPECT_FALSE(std::filesystem::exists("out"));
}

TEST(Simulation, ResetRepeatsTheRunBitIdentically) {
  Simulation simulation(bucket_scene(2));
  const std::string start = simulation.state_hash();
  dig(simulation, 300);
  const std::string end = simulation.state_hash();
  EXPECT_NE(end, start);
  simulation.reset();
  EXPECT_EQ(simulation.state_hash(), start);
  EXPECT_EQ(simulation.replacements(), 1u);
  dig(simulation, 300);
  EXPECT_EQ(simulation.state_hash(), end);
  // The present seed needs no new world.
  simulation.reset(simulation.world().description().seed);
  EXPECT_EQ(simulation.state_hash(), start);
}

TEST(Simulation, ResetToAnotherSeedChangesHillsThatFollowTheScene) {
  scene::Scene scene = bucket_scene(2);
  scene::GroundFeature hills;
  hills.kind = scene::GroundFeature::Kind::kHills;
  hills.height = 0.3;
  hills.length = 3;
  hills.seed = scene.seed;
  scene.ground.features.push_back(hills);
  Simulation simulation(std::move(scene), with_height_grid());
  const double before = simulation.heights().sample(1, 1);
  simulation.reset(99);
  EXPECT_NE(simulation.heights().sample(1, 1), before);
  EXPECT_EQ(simulation.world().description().seed, 99u);
  EXPECT_EQ(simulation.arrays().channels().size(), 1u) << "set_up is called again";
  simulation.reset(1);
  EXPECT_EQ(simulation.heights().sample(1, 1), before);
}

TEST(Simulation, SavesLoadsAndKeepsItsStateWhenALoadFails) {
  const navvy::test::Folder folder;
  Simulation simulation(bucket_scene(2));
  dig(simulation, 200);
  const std::string saved_hash = simulation.state_hash();
  simulation.save(folder / "s.snapshot");
  simulation.step(50);
  const std::string later = simulation.state_hash();
  EXPECT_THROW(simulation.load(folder / "none.snapshot"), Error);
  EXPECT_EQ(simulation.state_hash(), later);
  simulation.load(folder / "s.snapshot");
  EXPECT_EQ(simulation.state_hash(), saved_hash);
  simulation.step(50);
  EXPECT_EQ(simulation.state_hash(), later);
}

TEST(Simulation, ChangedReturnsRectanglesSinceTheLastCall) {
  Simulation simulation(bucket_scene(2));
  const auto all = simulation.changed();
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].area(), simulation.heights().site_rect().area());
  EXPECT_TRUE(simulation.changed().empty());
  const double before = simulation.heights().sample(-1.6, 0);
  dig(simulation, 600);
  const heightfield::TerrainView view = simulation.heights();
  EXPECT_NE(view.sample(-1.6, 0), before);
  const auto rects = simulation.changed();
  ASSERT_FALSE(rects.empty());
  const Vec2i column = view.column_at(-1.6, 0);
  EXPECT_TRUE(std::any_of(rects.begin(), rects.end(),
                          [&](const auto& rect) { return rect.contains(column.x(), column.y()); }));
  EXPECT_TRUE(simulation.changed().empty());
}

TEST(Simulation, DrawsACameraIntoMemory) {
  Simulation simulation(bucket_scene(2));
  const render::Image image = simulation.image("side");
  EXPECT_EQ(image.rgb.size(), static_cast<std::size_t>(3 * image.width * image.height));
  EXPECT_GT(image.width, 0);
  EXPECT_THROW(simulation.image("syde"), InputError);
}

TEST(Simulation, RunsToTheEndAndWritesItsFolder) {
  const navvy::test::Folder folder;
  SimulationOptions options;
  options.folder = folder / "out";
  options.snapshot = folder / "s.snapshot";
  options.snapshot_at = 0.1;
  scene::Scene scene = bucket_scene(0.2, &options.scene_text);
  Simulation simulation(std::move(scene), options);
  int calls = 0;
  LoopHooks hooks;
  hooks.progress = [&](const RunProgress& progress) {
    ++calls;
    EXPECT_GE(progress.remaining, 0);
  };
  const RunEnd end = simulation.run_to_end(hooks);
  EXPECT_EQ(end.reason, EndReason::kOutOfTime);
  EXPECT_FALSE(end.snapshot_missed);
  EXPECT_NEAR(end.time, 0.2, simulation.world().dt());
  EXPECT_EQ(calls, static_cast<int>(simulation.world().steps()));
  const json summary = json_of(folder / "out/summary.json");
  EXPECT_EQ(summary.at("status"), "incomplete");
  EXPECT_EQ(summary.at("state_hash"), simulation.state_hash());
  for (const char* file :
       {"out/telemetry.csv", "out/terrain_end.tif", "out/scene.sdf", "s.snapshot"})
    EXPECT_TRUE(std::filesystem::exists(folder / file)) << file;
  // The folder is closed; the simulation continues without it.
  simulation.reset();
  simulation.step();
  EXPECT_EQ(json_of(folder / "out/summary.json"), summary);
}

TEST(Simulation, HooksEndOrInterruptARun) {
  const navvy::test::Folder folder;
  SimulationOptions options;
  options.folder = folder / "out";
  {
    Simulation simulation(bucket_scene(2), options);
    LoopHooks hooks;
    hooks.before_step = [&] { return simulation.world().steps() < 5; };
    EXPECT_EQ(simulation.run_to_end(hooks).reason, EndReason::kEndRequested);
    EXPECT_EQ(simulation.world().steps(), 5u);
  }
  Simulation simulation(bucket_scene(2), options);
  LoopHooks hooks;
  hooks.interrupted = [&] { return std::string(simulation.world().steps() < 5 ? "" : "SIGTEST"); };
  const RunEnd end = simulation.run_to_end(hooks);
  EXPECT_EQ(end.reason, EndReason::kInterrupted);
  EXPECT_EQ(end.cause, "SIGTEST");
  const json summary = json_of(folder / "out/summary.json");
  EXPECT_EQ(summary.at("status"), "interrupted");
  EXPECT_EQ(summary.at("message"), "SIGTEST");
}

/// Counts its callbacks; throws after some steps.
class Counter final : public RunObserver {
 public:
  int fail_at = 1000, steps = 0, restarts = 0, closings = 0, finishes = 0;
  void after_step() override {
    if (++steps >= fail_at) throw FileError("the observer failed");
  }
  void restart() override { ++restarts; }
  void closing() override { ++closings; }
  void finish() override { ++finishes; }
};

TEST(Simulation, ObserversFollowStepsReplacementsAndTheEnd) {
  Simulation simulation(bucket_scene(2));
  Counter counter;
  simulation.attach(counter);
  simulation.step(3);
  simulation.reset();
  simulation.reset();
  EXPECT_EQ(counter.restarts, 0) << "informed before the next step";
  EXPECT_THROW(simulation.reset(7), Error) << "the observer belongs to this ground";
  simulation.step();
  EXPECT_EQ(counter.restarts, 1);
  simulation.finish();
  EXPECT_EQ(counter.steps, 4);
  EXPECT_EQ(counter.closings, 1);
  EXPECT_EQ(counter.finishes, 1);
}

TEST(Simulation, AFailureClosesTheFolderAsFailedAndIsThrown) {
  const navvy::test::Folder folder;
  SimulationOptions options;
  options.folder = folder / "out";
  Simulation simulation(bucket_scene(2), options);
  Counter counter;
  counter.fail_at = 4;
  simulation.attach(counter);
  EXPECT_THROW(simulation.step(10), FileError);
  EXPECT_EQ(counter.closings, 1);
  EXPECT_EQ(counter.finishes, 1);
  const json summary = json_of(folder / "out/summary.json");
  EXPECT_EQ(summary.at("status"), "failed");
  EXPECT_EQ(summary.at("message"), "the observer failed");
  EXPECT_TRUE(std::filesystem::exists(folder / "out/failed.snapshot"));
}

TEST(Simulation, ADestructorClosesTheFolder) {
  const navvy::test::Folder folder;
  SimulationOptions options;
  options.folder = folder / "out";
  Simulation(bucket_scene(2), options).step(3);
  EXPECT_EQ(json_of(folder / "out/summary.json").at("status"), "incomplete");
  EXPECT_TRUE(std::filesystem::exists(folder / "out/terrain_end.tif"));
}

TEST(Simulation, RecordsArraysThatNumPyReadsInOneLine) {
  const navvy::test::Folder folder;
  SimulationOptions options = with_height_grid();
  options.folder = folder / "out";
  Simulation simulation(bucket_scene(0.2), options);
  simulation.run_to_end();
  const json index = json_of(folder / "out/arrays/index.json");
  ASSERT_EQ(index.size(), 1u);
  EXPECT_EQ(index[0].at("name"), "bucket/height_grid");
  EXPECT_EQ(index[0].at("shape"), json({5, 5}));
  const std::string file = folder / ("out/" + index[0].at("file").get<std::string>());
  const sim::ArrayView last = simulation.arrays().view("bucket/height_grid");
  // 72 bytes of stamp and pose, and 25 floats, in each record.
  EXPECT_EQ(navvy::test::text_of(file).size() % 64, last.sequence() * (72 + 100) % 64);
  const std::string script =
      "import numpy, sys\nrows = numpy.load(sys.argv[1])\n"
      "assert len(rows) == int(sys.argv[2]), len(rows)\n"
      "assert abs(rows['time_s'][-1] - float(sys.argv[3])) < 1e-9\n"
      "assert rows['values'].shape == (len(rows), 5, 5) and rows['values'].dtype == 'f4'\n"
      "assert abs(rows['quaternion_wxyz'][0][0] - 1) < 1e-9\n"
      "assert (rows['sequence'] == numpy.arange(1, len(rows) + 1)).all()\n";
  if (std::system("/usr/bin/python3 -c 'import numpy' >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "NumPy for /usr/bin/python3 is missing (python3-numpy)";
  std::ofstream(folder / "read.py") << script;
  const std::string command = "/usr/bin/python3 '" + (folder / "read.py") + "' '" + file + "' " +
                              std::to_string(last.sequence()) + " " + json(last.time()).dump();
  EXPECT_EQ(std::system(command.c_str()), 0);
}

TEST(Simulation, RecordsParticlesAtARateWithAnIndex) {
  const navvy::test::Folder folder;
  SimulationOptions options;
  options.folder = folder / "out";
  options.particles = {10, "vtu"};
  Simulation simulation(bucket_scene(10), options);
  const auto steps = [&](double time) {
    return static_cast<int>(std::round(time / simulation.world().dt()));
  };
  simulation.step(steps(1.2));
  const std::string last = folder / "out/particles/particles_000012.vtu";
  ASSERT_TRUE(std::filesystem::exists(last));
  EXPECT_FALSE(std::filesystem::exists(folder / "out/particles/particles_000013.vtu"));
  ASSERT_GT(simulation.world().soil().counts().particles, 100);
  formats::particle_format_named("vtu").write(sim::read_particles(simulation.world()),
                                              folder / "now.vtu");
  EXPECT_EQ(navvy::test::text_of(last), navvy::test::text_of(folder / "now.vtu"));
  // After a reset the files have another name, and those of the first time remain.
  simulation.reset();
  simulation.step(steps(0.1));
  simulation.finish();
  EXPECT_EQ(navvy::test::text_of(folder / "out/particles/particles_2_000001.vtu"),
            navvy::test::text_of(folder / "out/particles/particles_000001.vtu"));
  const std::string index = navvy::test::text_of(folder / "out/particles/particles.pvd"),
                    second = navvy::test::text_of(folder / "out/particles/particles_2.pvd");
  const auto entries = [](const std::string& text) {
    std::size_t count = 0, at = 0;
    while ((at = text.find("<DataSet ", at) + 1) != 0) ++count;
    return count;
  };
  EXPECT_EQ(entries(index), 13u) << index;
  EXPECT_NE(index.find("file=\"particles_000012.vtu\""), std::string::npos) << index;
  EXPECT_EQ(entries(second), 2u) << second;
}

TEST(Simulation, RefusesRatesAndFormatsOfParticlesBeforeItTouchesTheFolder) {
  const navvy::test::Folder folder;
  const auto refused = [&](const record::ParticleRecord& record) -> std::string {
    SimulationOptions options;
    options.folder = folder / "out";
    options.particles = record;
    try {
      const Simulation simulation(bucket_scene(0.1), options);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  for (const double rate : {-1.0, 1e-4, 1e9, std::nan("")})
    EXPECT_NE(refused({rate, "npz"}).find("from 0.001 to 1000"), std::string::npos) << rate;
  EXPECT_NE(refused({10, "vtk"}).find("did you mean 'vtu'?"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

TEST(Simulation, RecordsReadingsOfSensorsWithTheirTimes) {
  const navvy::test::Folder folder;
  SimulationOptions options;
  options.folder = folder / "out";
  Simulation simulation(test::gauged_scene(0.2), options);
  simulation.run_to_end();
  const std::uint64_t readings = simulation.arrays().view("bucket/gauge/state").sequence();
  EXPECT_GE(readings, 9u);
  EXPECT_TRUE(std::filesystem::exists(folder / "out/sensors/bucket/gauge/state.npy"));
  EXPECT_EQ(json_of(folder / "out/arrays/index.json")[0].at("file"),
            "sensors/bucket/gauge/state.npy");
  std::istringstream rows(navvy::test::text_of(folder / "out/sensors/bucket/gauge/index.csv"));
  std::string row;
  std::getline(rows, row);
  EXPECT_EQ(row, "reading,measured_s,delivered_s,latency_s");
  std::uint64_t count = 0;
  for (; std::getline(rows, row); ++count) {
    unsigned long long number = 0;
    double measured = 0, delivered = 0, latency = 0;
    ASSERT_EQ(
        std::sscanf(row.c_str(), "%llu,%lf,%lf,%lf", &number, &measured, &delivered, &latency), 4);
    EXPECT_EQ(number, count + 1);
    EXPECT_NEAR(measured, 0.02 * static_cast<double>(count), 0.001);
    EXPECT_GE(latency, 0.005 - 1e-6);
    EXPECT_LT(latency, 0.005 + simulation.world().dt());
  }
  EXPECT_EQ(count, readings);
  const json sensors = json_of(folder / "out/summary.json").at("sensors");
  ASSERT_EQ(sensors.size(), 1u);
  EXPECT_EQ(sensors[0].at("name"), "bucket/gauge");
  EXPECT_EQ(sensors[0].at("readings"), readings);
}

TEST(Simulation, RecordsPicturesOfSensorsAsPngFiles) {
  const navvy::test::Folder folder;
  SimulationOptions options;
  options.folder = folder / "out";
  Simulation simulation(test::scene_with_cameras(0.25), options);
  simulation.run_to_end();
  const sim::ArrayView eye = simulation.arrays().view("bucket/eye/image"),
                       labels = simulation.arrays().view("bucket/labels/labels");
  ASSERT_EQ(eye.sequence(), 3u);
  for (const json& entry : json_of(folder / "out/arrays/index.json"))
    EXPECT_NE(entry.at("file").get<std::string>().find("_{reading:06}.png"), std::string::npos);
  const render::Image image = render::read_png(folder / "out/sensors/bucket/eye/image_000003.png");
  EXPECT_EQ(image.width, 32);
  EXPECT_EQ(image.height, 24);
  const auto rgb = eye.values<std::uint8_t>();
  EXPECT_TRUE(std::equal(rgb.begin(), rgb.end(), image.rgb.begin(), image.rgb.end()));
  const std::string script =
      "import sys\nfrom PIL import Image\np = Image.open(sys.argv[1])\n"
      "assert p.size == (32, 24) and p.mode.startswith('I'), (p.size, p.mode)\n"
      "assert p.getpixel((16, 23)) == int(sys.argv[2]), p.getpixel((16, 23))\n";
  if (std::system("/usr/bin/python3 -c 'import PIL' >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "Pillow for /usr/bin/python3 is missing (python3-pil)";
  std::ofstream(folder / "read.py") << script;
  const std::string command = "/usr/bin/python3 '" + (folder / "read.py") + "' '" +
                              (folder / "out/sensors/bucket/labels/labels_000003.png") + "' " +
                              std::to_string(labels.values<std::uint16_t>()[32 * 23 + 16]);
  EXPECT_EQ(std::system(command.c_str()), 0);
}

TEST(Simulation, ResetRepeatsTheReadingsOfSensors) {
  Simulation simulation(test::gauged_scene(2));
  simulation.step(100);
  const double first = simulation.arrays().view("bucket/gauge/state").values<double>()[0];
  const std::uint64_t count = simulation.arrays().view("bucket/gauge/state").sequence();
  simulation.reset();
  EXPECT_EQ(simulation.arrays().view("bucket/gauge/state").sequence(), 0u);
  simulation.step(100);
  EXPECT_EQ(simulation.arrays().view("bucket/gauge/state").sequence(), count);
  EXPECT_EQ(simulation.arrays().view("bucket/gauge/state").values<double>()[0], first);
}

}  // namespace
}  // namespace navvy::run
