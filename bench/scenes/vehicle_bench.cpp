// SPDX-License-Identifier: Apache-2.0
// Steps of machines alone, without particles: the EW180 on firm ground, on loam with its ruts, beside 200 bodies, and
// four of them: vehicle_bench [NAME], rows whose name holds NAME. A row is a second of simulated time; `particles`
// counts machines and bodies.
#include <cstdio>
#include <exception>
#include <functional>
#include <string>
#include <vector>

#include "bench.h"
#include "coupling/ground_view.h"
#include "coupling/ruts.h"
#include "heightfield/site.h"
#include "scene_io/loader.h"
#include "vehicle/engine.h"

namespace {

using namespace navvy;

constexpr double kStep = 1.0 / 600;
constexpr int kSteps = 600, kRuns = 5;

class FirmGround final : public terramechanics::GroundQuery {
 public:
  double height(double, double) const override { return 0; }
  Vec3 normal(double, double) const override { return Vec3::UnitZ(); }
};

/// A box of 1 m and 1000 kg that lies on the ground.
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

/// Who is there, and what is under them.
struct Case {
  std::string name;
  int excavators = 1, boxes = 0;
  bool loam = false;
};

void measure_case(const Case& what, const scene::Machine& excavator) {
  const auto engine = vehicle::make_bullet_engine(Vec3(0, 0, -kGravity));
  for (int i = 0; i < what.excavators; ++i) engine->add_machine(excavator, make_pose(0, 6.0 * i, 0));
  for (int i = 0; i < what.boxes; ++i) engine->add_machine(box(), make_pose(4 + 2 * (i % 20), -4 - 2 * (i / 20), 0.5));
  for (int i = 0; i < what.excavators; ++i) engine->set_drive(i, {1, 0, false});
  scene::Scene site;
  site.soils.emplace_back();
  site.ground.size = Vec2(80, 60);
  site.ground.layers.push_back({site.soils[0].name, 1});
  heightfield::Ground ground = heightfield::make_ground(site);
  coupling::Ruts ruts(ground);
  const coupling::GroundView columns(ground, ground.setup().soils, &ruts);
  const FirmGround firm;
  const terramechanics::GroundQuery* under = &firm;
  if (what.loam) under = &columns;
  const auto second = [&] {
    for (int step = 0; step < kSteps; ++step) {
      engine->step(kStep, *under);
      if (!what.loam || step % coupling::kRutInterval != 0) continue;
      std::vector<coupling::LoadedTyre> tyres;
      for (int m = 0; m < what.excavators; ++m)
        for (std::size_t w = 0; w < excavator.wheels.size(); ++w)
          tyres.push_back({excavator.wheels[w], engine->wheel(m, static_cast<int>(w))});
      ruts.press(tyres, coupling::kRutInterval * kStep);
    }
  };
  second();
  bench::Row row;
  row.timing = bench::measure(
      kRuns, [] {}, second);
  row.bench = "vehicle_step:" + what.name;
  row.particles = static_cast<std::uint64_t>(what.excavators + what.boxes);
  row.steps = kSteps;
  row.simulated = kSteps * kStep;
  bench::print_host(row);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 2) {
    std::fprintf(stderr, "usage: vehicle_bench [NAME]   rows whose name holds NAME\n");
    return 2;
  }
  const std::string wanted = argc > 1 ? argv[1] : "";
  try {
    const scene::Machine excavator = scene_io::load_machine(scene_io::find_data("vehicles/ew180/model.sdf"));
    for (const Case& each : {Case{"firm"}, Case{"loam", 1, 0, true}, Case{"200_bodies", 1, 200}, Case{"four", 4}})
      if (("vehicle_step:" + each.name).find(wanted) != std::string::npos) measure_case(each, excavator);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
