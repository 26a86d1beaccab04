// SPDX-License-Identifier: Apache-2.0
// Steps of machines only, without particles: the EW180 on firm ground, on loam with its ruts,
// beside 200 bodies, and two, four and eight of them; the crawler; a light truck on 50 x 50 m of
// fine loam. `vehicle_bench [NAME]` runs the rows whose name contains NAME. A row is one second of
// simulated time; `particles` counts machines and bodies. The memory of ground and ruts goes to
// stderr, per column of the touched tiles and per column that a wheel or track moved.
#include <malloc.h>

#include <cstdio>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include "bench.h"
#include "coupling/ground_view.h"
#include "coupling/ruts.h"
#include "coupling/track_ruts.h"
#include "heightfield/make_ground.h"
#include "scene_io/loader.h"
#include "vehicle/physics_engine.h"

namespace {

using namespace navvy;

constexpr double kStep = 1.0 / 600;
constexpr int kSteps = 600, kRuns = 5;

class FirmGround final : public terramechanics::GroundQuery {
 public:
  double height(double, double) const override { return 0; }
  double highest(const Vec2&, const Vec2&) const override { return 0; }
  Vec3 normal(double, double) const override { return Vec3::UnitZ(); }
};

/// Returns a box of 1 m and 1000 kg on the ground.
scene::Machine box() {
  scene::Machine m;
  m.name = "box";
  scene::Link link;
  link.name = "box";
  link.mass = 1000;
  link.inertia = Mat3::Identity() * (1000.0 / 6);
  link.collisions.push_back({});
  m.links.push_back(link);
  return m;
}

/// Machines of a case, and the ground under them.
struct Case {
  std::string name, machine;
  int machines = 1, boxes = 0;
  bool loam = false;
  // Edge length of a column [m].
  double cell = 0.1;
  Vec2 site = Vec2(80, 60);
  // Travel speed [m/s].
  double speed = 1;
};

const std::vector<Case> kCases = {
    {"firm", "ew180"},
    {"loam", "ew180", 1, 0, true},
    {"200_bodies", "ew180", 1, 200},
    {"two", "ew180", 2},
    {"four", "ew180", 4},
    {"eight", "ew180", 8},
    {"tracks_firm", "ex180_tracked"},
    {"tracks_loam", "ex180_tracked", 1, 0, true},
    {"light_loam_50x50", "light_truck", 1, 0, true, 0.05, Vec2(50, 50), 4}};

/// Returns the number of columns whose height has changed since the start.
std::size_t moved_columns(const heightfield::Ground& ground) {
  // Only in touched tiles: reading others would make the ground store them.
  const heightfield::CellRect rect = ground.touched_rect();
  std::size_t moved = 0;
  for (int iy = rect.y0; iy < rect.y1; ++iy)
    for (int ix = rect.x0; ix < rect.x1; ++ix)
      moved += ground.height(ix, iy) != ground.start_height(ix, iy) ? 1 : 0;
  return moved;
}

/// Machines on columns or on firm ground, as a world steps them without particles.
class Stage {
 public:
  Stage(const Case& what, const scene::Machine& machine)
      : machine_(machine),
        loam_(what.loam),
        ground_(heightfield::make_ground(site_of(what))),
        ruts_(ground_),
        track_ruts_(ground_, ruts_),
        columns_(ground_, ground_.setup().soils, &ruts_),
        engine_(vehicle::make_bullet_engine(Vec3(0, 0, -kGravity))) {
    for (int i = 0; i < what.machines; ++i) engine_->add_machine(machine, make_pose(0, 6.0 * i, 0));
    for (int i = 0; i < what.boxes; ++i) {
      const int row = i / 20;
      engine_->add_machine(box(), make_pose(4 + 2 * (i % 20), -4 - 2 * row, 0.5));
    }
    for (int i = 0; i < what.machines; ++i) engine_->set_drive(i, {what.speed, 0, false});
  }

  void second() {
    for (int step = 0; step < kSteps; ++step) {
      engine_->step(kStep,
                    loam_ ? static_cast<const terramechanics::GroundQuery&>(columns_) : firm_);
      if (loam_ && step % coupling::kRutInterval == 0) press();
    }
  }
  const heightfield::Ground& ground() const { return ground_; }

 private:
  static scene::Scene site_of(const Case& what) {
    scene::Scene site;
    site.soils.emplace_back();
    site.solver.cell = what.cell;
    site.ground.size = what.site;
    site.ground.origin = Vec2(-10, -10);
    site.ground.layers.push_back({site.soils[0].name, 1});
    return site;
  }
  void press() {
    std::vector<coupling::LoadedTyre> tyres;
    std::vector<terramechanics::TrackPatch> running_tracks;
    for (int m = 0; m < engine_->machine_count(); ++m)
      for (std::size_t w = 0; w < machine_.wheels.size(); ++w) {
        const int wheel = static_cast<int>(w);
        if (!machine_.wheels[w].track) {
          tyres.push_back({machine_.wheels[w], engine_->wheel(m, wheel)});
          continue;
        }
        for (const terramechanics::TrackPatch& patch : engine_->tracks()->track_patches(m, wheel))
          running_tracks.push_back(patch);
      }
    const double interval = coupling::kRutInterval * kStep;
    ruts_.press(tyres, interval);
    if (!running_tracks.empty())
      track_ruts_.press(running_tracks, coupling::kSinkSpeed * interval, tyres.empty());
  }

  const scene::Machine& machine_;
  bool loam_;
  heightfield::Ground ground_;
  coupling::Ruts ruts_;
  coupling::TrackRuts track_ruts_;
  coupling::GroundView columns_;
  FirmGround firm_;
  std::unique_ptr<vehicle::PhysicsEngine> engine_;
};

void measure_case(const Case& what) {
  const scene::Machine machine =
      scene_io::load_machine(scene_io::find_data("vehicles/" + what.machine + "/model.sdf"));
  Stage stage(what, machine);
  stage.second();
  bench::Row row;
  // Memory of the ground and its ruts; other allocations of a step are freed.
  const std::size_t moved_before = moved_columns(stage.ground());
  const std::size_t before = mallinfo2().uordblks, tiles = stage.ground().touched_tiles();
  row.timing = bench::measure(
      kRuns, [] {}, [&] { stage.second(); });
  const std::size_t touched = (stage.ground().touched_tiles() - tiles) * 32 * 32;
  if (touched > 0) {
    const auto bytes = static_cast<double>(mallinfo2().uordblks - before);
    const std::size_t moved = moved_columns(stage.ground()) - moved_before;
    std::fprintf(
        stderr,
        "vehicle_step:%s: %.0f bytes a touched column, %zu columns; %.0f a moved one, %zu\n",
        what.name.c_str(), bytes / static_cast<double>(touched), touched,
        bytes / static_cast<double>(moved), moved);
  }
  row.bench = "vehicle_step:" + what.name;
  row.particles = static_cast<std::uint64_t>(what.machines + what.boxes);
  row.steps = kSteps;
  row.simulated = kSteps * kStep;
  bench::print_host(row);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 2) {
    std::fprintf(stderr, "usage: vehicle_bench [NAME]   rows whose name contains NAME\n");
    return 2;
  }
  const std::string wanted = argc > 1 ? argv[1] : "";
  try {
    for (const Case& each : kCases)
      if (("vehicle_step:" + each.name).find(wanted) != std::string::npos) measure_case(each);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
