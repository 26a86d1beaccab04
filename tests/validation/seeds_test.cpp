// SPDX-License-Identifier: Apache-2.0
// The trench and the loaded truck from ten starts each: uneven ground, and machines that stand a
// little aside. One shipped scene is one draw; what a controller meets is a spread.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "core/random.h"
#include "record/summary.h"
#include "session/soil_mass.h"
#include "validation/loads.h"
#include "validation/report.h"
#include "validation/scenes.h"
#include "validation/trench_measure.h"

namespace navvy::validation {
namespace {

constexpr int kSeeds = 10;
constexpr const char* kSource = "ten seeds [docs/validation.md, Whole digs]";

/// Returns a shipped scene with hills of 6 cm and each machine up to 10 cm and 1.5 deg aside.
scene::Scene varied(const std::string& name, int seed) {
  scene::Scene scene = load_scene(name);
  scene::GroundFeature hills = scene::GroundFeature::of(scene::GroundFeature::Kind::kHills);
  hills.height = 0.06;
  hills.length = 5;
  hills.seed = static_cast<std::uint64_t>(seed);
  hills.has_seed = true;
  scene.ground.features.push_back(hills);
  scene.seed = static_cast<std::uint64_t>(seed);
  Random random(static_cast<std::uint64_t>(seed));
  for (scene::MachineInWorld& machine : scene.machines) {
    const double x = random.uniform(-0.1, 0.1), y = random.uniform(-0.1, 0.1),
                 yaw = radians(random.uniform(-1.5, 1.5));
    const Vec3 p = machine.X_WM.translation();
    machine.X_WM.linear() = make_pose(0, 0, 0, 0, 0, yaw).linear() * machine.X_WM.linear();
    machine.X_WM.translation() = p + Vec3(x, y, 0);
  }
  return scene;
}

/// Results of all seeds, by name.
class Spread {
 public:
  void add(double value) { values_.push_back(value); }
  double median() const {
    std::vector<double> sorted = values_;
    std::sort(sorted.begin(), sorted.end());
    return 0.5 * (sorted[(sorted.size() - 1) / 2] + sorted[sorted.size() / 2]);
  }
  double low() const { return *std::min_element(values_.begin(), values_.end()); }
  double high() const { return *std::max_element(values_.begin(), values_.end()); }
  /// Judges the median, and prints the extremes.
  void judge(const std::string& name, double least, double most) const {
    expect_between("median " + name, median(), least, most, kSource);
    std::printf("%s: %.4g to %.4g\n", name.c_str(), low(), high());
  }

 private:
  std::vector<double> values_;
};

TEST(TrenchSeeds, TenTrenchesEndByThemselves) {
  int ended = 0;
  std::int64_t ledger = 0, crossings = 0;
  Spread payload, cycles, time, overdug, rate;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const scene::Scene scene = varied("trench.sdf", seed);
    const control::Dig dig = dig_step(scene);
    session::Session session(scene, shared_device());
    while (!session.done()) session.step();
    const TrenchMeasure trench = measure(session.world().ground(), dig);
    const double removed = trench.inside_volume / trench.design_volume;
    ended += session.complete() && removed >= 0.85;
    ledger = std::max<std::int64_t>(ledger, std::abs(session.world().soil().mass_ledger().error));
    crossings += session.world().soil().counts().shell_crossings;
    const double bank = record::measure_earthwork(session.world()).bank_volume;
    const double dug = session.cycles().empty()
                           ? kNoLimit
                           : session.cycles().back().end - session.cycles().front().start;
    payload.add(mean_payload(session) / heaped_load(scene));
    cycles.add(static_cast<double>(session.cycles().size()));
    time.add(session.world().time());
    overdug.add(trench.overdug / trench.design_volume);
    rate.add(bank / dug * 3600);
    std::printf("seed %d: %zu cycles, %.0f kg a cycle, %.1f s, over-dug %.3f, removed %.3f%s\n",
                seed, session.cycles().size(), mean_payload(session), session.world().time(),
                trench.overdug / trench.design_volume, removed,
                session.complete() ? "" : ", incomplete");
    std::fflush(stdout);
  }
  expect_between("trenches that end by themselves with 0.85 removed", ended, 9, kSeeds, kSource);
  payload.judge("mean payload of all cycles / heaped bucket", 0.7, 1.1);
  cycles.judge("cycles", 3, 7);
  time.judge("time of the whole trench [s]", 10, 125);
  overdug.judge("over-dug, share of design volume", 0, 0.08);
  rate.judge("bank volume dug per hour [m3/h]", 90, 200);
  expect_between("largest ledger error [units]", static_cast<double>(ledger), 0, 0, kSource);
  expect_between("shell crossings", static_cast<double>(crossings), 0, 0, kSource);
}

TEST(TruckSeeds, TenTrucksAreLoadedAndTip) {
  int ended = 0;
  std::int64_t ledger = 0, crossings = 0;
  Spread payload, bed;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const scene::Scene scene = varied("load_truck.sdf", seed);
    session::Session session(scene, shared_device());
    const sim::World& world = session.world();
    while (!session.done()) session.step();
    const int truck = world.description().machine_index("dumper");
    ended += session.complete() && session.tips().size() == 2;
    ledger = std::max<std::int64_t>(ledger, std::abs(world.soil().mass_ledger().error));
    crossings += world.soil().counts().shell_crossings;
    const double sum = mean_payload(session) * static_cast<double>(session.cycles().size());
    const double carried = session.tips().empty() ? 0 : session.tips()[0].payload_start;
    payload.add(mean_payload(session) / heaped_load(scene));
    bed.add(carried / std::max(1.0, sum));
    std::printf("seed %d: %zu cycles, %.0f kg a cycle, bed / payloads %.4f, left %.1f kg%s\n", seed,
                session.cycles().size(), mean_payload(session), carried / std::max(1.0, sum),
                session::testing::carried(world, truck, "bed"),
                session.complete() ? "" : ", incomplete");
    std::fflush(stdout);
  }
  expect_between("trucks that are loaded and tip", ended, 9, kSeeds, kSource);
  payload.judge("mean payload of all cycles / heaped bucket", 0.85, 1.1);
  bed.judge("bed mass / sum of payloads", 0.99, 1.01);
  expect_between("largest ledger error [units]", static_cast<double>(ledger), 0, 0, kSource);
  expect_between("shell crossings", static_cast<double>(crossings), 0, 0, kSource);
}

}  // namespace
}  // namespace navvy::validation
