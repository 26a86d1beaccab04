// SPDX-License-Identifier: Apache-2.0
#include "record/replay_frames.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "record/replay_packing.h"
#include "record/replay_shapes.h"
#include "record/tool_point.h"
#include "sim/cylinder_shapes.h"

namespace navvy::record {
namespace {

using nlohmann::json;

void append(const Vec3& p, std::vector<float>& out) {
  for (const double x : p) out.push_back(static_cast<float>(x));
}

void append(const Pose& pose, std::vector<float>& out) {
  append(pose.translation(), out);
  const Eigen::Quaterniond q(pose.linear());
  for (const double x : {q.w(), q.x(), q.y(), q.z()}) out.push_back(static_cast<float>(x));
}

/// Returns the middle of all machines in plan, or that of the site if there are none.
Vec2 middle_of(const sim::World& world) {
  const heightfield::Ground& ground = world.ground();
  const std::size_t count = world.description().machines.size();
  if (count == 0) return ground.origin() + 0.5 * ground.cell() * Vec2(ground.nx(), ground.ny());
  Vec2 sum = Vec2::Zero();
  for (std::size_t m = 0; m < count; ++m)
    sum += world.machines().at(static_cast<int>(m)).link(0).pose().translation().head<2>();
  return sum / static_cast<double>(count);
}

/// Returns the unit of the particles' coordinates [m], a centimetre on all but large sites.
double particle_unit(const ReplayHeights& heights, double cell) {
  const int most = std::max(heights.window().x1 - heights.window().x0,
                            heights.window().y1 - heights.window().y0);
  return std::max(0.01, most * cell / 30000);
}

}  // namespace

ReplayFrames::ReplayFrames(const session::Session& session, std::size_t most_particles)
    : session_(session),
      most_particles_(most_particles),
      soil_(session.world()),
      heights_((soil_.update(), soil_.surface()), middle_of(session.world())) {}

json ReplayFrames::header(double rate) const {
  const sim::World& world = session_.world();
  const heightfield::Ground& ground = world.ground();
  const heightfield::CellRect& window = heights_.window();
  const Vec2 corner = ground.origin() + ground.cell() * Vec2(window.x0, window.y0);
  json soils = json::array();
  for (const scene::Soil& soil : world.description().soils)
    soils.push_back({{"name", soil.name}, {"color", soil.color}});
  json machines = json::array();
  for (const scene::MachineInWorld& placed : world.description().machines)
    machines.push_back(placed.name);
  json out = {{"format", 1},
              {"rate_hz", rate},
              {"grid",
               {{"nx", window.x1 - window.x0},
                {"ny", window.y1 - window.y0},
                {"cell_m", ground.cell()},
                {"origin_m", {corner.x(), corner.y()}},
                {"unit_m", heights_.unit()},
                {"base_m", heights_.base()},
                {"particle_unit_m", particle_unit(heights_, ground.cell())},
                {"whole_site",
                 window.x1 - window.x0 == ground.nx() && window.y1 - window.y0 == ground.ny()}}},
              {"start", packed(heights_.numbers())},
              {"design", nullptr},
              {"soils", soils},
              {"machines", machines},
              {"links", replay_links(world.description())},
              {"cylinders", replay_cylinders(world)},
              {"forces", replay_forces(world.description())}};
  if (const heightfield::DesignSurface* design = session_.design())
    out["design"] = packed(heights_.numbers_of(*design));
  return out;
}

json ReplayFrames::frame() {
  const sim::World& world = session_.world();
  soil_.update();
  std::vector<float> poses, cylinders, forces;
  json phases = json::array();
  const auto& machines = world.description().machines;
  for (std::size_t m = 0; m < machines.size(); ++m) {
    const int index = static_cast<int>(m);
    const sim::MachineHandle handle = world.machines().at(index);
    const scene::Machine& machine = machines[m].machine;
    for (std::size_t l = 0; l < machine.links.size(); ++l)
      append(handle.link(static_cast<int>(l)).pose(), poses);
    std::vector<scene::FrameCylinder> bars;
    sim::add_cylinder_shapes(world, index, bars);
    for (const scene::FrameCylinder& bar : bars) {
      append(bar.p_base, cylinders);
      append(bar.p_rod, cylinders);
    }
    for (std::size_t s = 0; s < machine.shells.size(); ++s) {
      const int link = machine.link_index(machine.shells[s].link);
      append(handle.link(link).pose() * tool_point(machine.shells[s]), forces);
      append(handle.tool(static_cast<int>(s)).smooth_force(), forces);
    }
    phases.push_back(session_.phase(index));
  }
  return {{"time_s", world.time()},           {"poses", packed(poses)},
          {"cylinders", packed(cylinders)},   {"forces", packed(forces)},
          {"particles", packed(particles())}, {"phases", phases}};
}

std::vector<std::int16_t> ReplayFrames::tiles(bool all) {
  return heights_.take(soil_.surface(), all);
}

std::vector<std::int16_t> ReplayFrames::particles() const {
  const std::vector<sim::SoilBall>& balls = soil_.balls();
  const std::size_t every = balls.size() / most_particles_ + 1;
  const heightfield::Ground& ground = session_.world().ground();
  const Vec2 corner =
      ground.origin() + ground.cell() * Vec2(heights_.window().x0, heights_.window().y0);
  const double unit = particle_unit(heights_, ground.cell());
  const Vec3 from(corner.x(), corner.y(), heights_.base());
  std::vector<std::int16_t> out;
  out.reserve(3 * (balls.size() / every + 1));
  for (std::size_t i = 0; i < balls.size(); i += every) {
    const Vec3 p = (soil_.origin() + balls[i].p_O.cast<double>() - from) / unit;
    for (const double x : p)
      out.push_back(static_cast<std::int16_t>(
          std::clamp(std::round(x), double{INT16_MIN}, double{INT16_MAX})));
  }
  return out;
}

}  // namespace navvy::record
