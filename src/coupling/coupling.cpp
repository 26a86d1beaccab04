// SPDX-License-Identifier: Apache-2.0
#include "coupling/coupling.h"

#include <algorithm>
#include <cmath>

#include "core/stopwatch.h"
#include "coupling/hitching.h"
#include "coupling/machine_placing.h"
#include "coupling/support_areas.h"

namespace navvy::coupling {
namespace {

// [Hz] about v / (2 cell) at 0.6 m/s and 0.1 m.
constexpr double kForceCutoff = 3.0;

}  // namespace

// Adds machines and shells in the scene's order, so that their indices follow it.
Coupling::Coupling(const scene::Scene& world, vehicle::PhysicsEngine& engine,
                   vehicle::PhysicsEngine& kinematic, soil::Solver& solver,
                   heightfield::Ground& ground)
    : world_(world),
      dynamic_(engine),
      kinematic_(kinematic),
      solver_(solver),
      ground_(ground),
      ruts_(ground),
      track_ruts_(ground, ruts_),
      view_(ground, ground.setup().soils, &ruts_) {
  for (std::size_t m = 0; m < world.machines.size(); ++m) {
    const scene::MachineInWorld& placed = world.machines[m];
    // Both engines number their machines from 0: store the index of each machine of the scene.
    vehicle::PhysicsEngine& mover = placed.machine.kinematic ? kinematic : engine;
    placed_.push_back({&mover, mover.add_machine(placed.machine, place(placed, ground))});
    // An engine without contacts has no use for obstacles.
    if (vehicle::ObstacleCapability* obstacles = engine.obstacles();
        obstacles && placed.machine.kinematic)
      placed_.back().mover = obstacles->add_obstacle(placed.machine);
    for (const scene::Wheel& wheel : placed.machine.wheels) has_tracks_ |= wheel.track.has_value();
    for (std::size_t s = 0; s < placed.machine.shells.size(); ++s) {
      const scene::Shell& shell = placed.machine.shells[s];
      ToolLoad load;
      load.machine = static_cast<int>(m);
      load.shell = static_cast<int>(s);
      load.link = placed.machine.link_index(shell.link);
      load.tool = solver.add_tool(placed.machine.with_teeth(shell));
      tools_.push_back(load);
    }
  }
  if (vehicle::RockCapability* rock = engine.rock()) rock->set_rock(ground.datum());
  add_hitches(world, engine, [this](int machine) { return index(machine); });
}

// Passes the buckets that may reach into a bed, whose soil the solver then excludes.
double Coupling::payload(const ToolLoad& tool) const {
  const auto pose = [&](const ToolLoad& t) {
    return engine(t.machine).link(index(t.machine), t.link).X_WL;
  };
  const auto machine = [&](const ToolLoad& t) -> const scene::Machine& {
    return world_.machines[static_cast<std::size_t>(t.machine)].machine;
  };
  std::vector<soil::PlacedTool> buckets;  // buckets that may be inside the bed
  if (machine(tool).is_bed(tool.shell))
    for (const ToolLoad& other : tools_)
      if (other.tool != tool.tool && machine(other).is_bucket(other.shell))
        buckets.push_back({other.tool, pose(other)});
  return solver_.payload(tool.tool, pose(tool), buckets);
}

std::vector<soil::PlacedTool> Coupling::containers() const {
  std::vector<soil::PlacedTool> out;
  for (const ToolLoad& tool : tools_) {
    const scene::Machine& machine = world_.machines[static_cast<std::size_t>(tool.machine)].machine;
    // Soil ahead of a blade is on the ground, even inside the blade's convex hull.
    if (machine.is_bucket(tool.shell) || machine.is_bed(tool.shell))
      out.push_back({tool.tool, engine(tool.machine).link(index(tool.machine), tool.link).X_WL});
  }
  return out;
}

std::function<bool(const Vec3&)> Coupling::holding() const { return solver_.holding(containers()); }

// Machines move first; the soil then answers over the same interval.
void Coupling::step(double dt) {
  // Soil acts over the interval that starts at these poses.
  std::vector<Pose> before;
  before.reserve(tools_.size());
  for (const ToolLoad& tool : tools_)
    before.push_back(engine(tool.machine).link(index(tool.machine), tool.link).X_WL);
  {
    const Lap lap(time_share_.vehicle);
    if (dynamic_.machine_count() > 0) {
      show_movers();
      dynamic_.step(dt, view_);
    }
    if (kinematic_.machine_count() > 0) kinematic_.step(dt, view_);
  }
  {
    const Lap lap(time_share_.soil);
    exchange_with_soil(dt, before);
  }
  const Lap lap(time_share_.ground);
  if (steps_ % kRutInterval == 0) press_ruts(dt);
  ++steps_;
}

// Obstacles take the pose at the start of the step and the present velocity.
void Coupling::show_movers() {
  std::vector<vehicle::LinkState> links;
  for (std::size_t m = 0; m < placed_.size(); ++m) {
    if (placed_[m].mover < 0) continue;
    links.clear();
    for (std::size_t l = 0; l < world_.machines[m].machine.links.size(); ++l)
      links.push_back(placed_[m].engine->link(placed_[m].index, static_cast<int>(l)));
    dynamic_.obstacles()->move_obstacle(placed_[m].mover, links);
  }
}

// Sends poses, velocities and inverse masses, and applies the impulses that come back.
void Coupling::exchange_with_soil(double dt, const std::vector<Pose>& poses_before) {
  std::vector<soil::ToolMotion> motions(tools_.size());
  std::vector<soil::ToolImpulse> impulses(tools_.size());
  for (std::size_t i = 0; i < tools_.size(); ++i) {
    const ToolLoad& tool = tools_[i];
    const vehicle::LinkState link = engine(tool.machine).link(index(tool.machine), tool.link);
    motions[i].tool = tool.tool;
    motions[i].X_WT = poses_before[i];
    motions[i].v_WT = link.v_WL;
    motions[i].w_WT = link.w_WL;
    motions[i].inverse_mass = engine(tool.machine).inverse_mass(index(tool.machine), tool.link);
  }
  solver_.step(dt, motions, impulses, support_areas(dt));
  // A first-order low-pass, exact at any dt for a force that is constant over the step.
  const double blend = 1 - std::exp(-2 * kPi * kForceCutoff * dt);
  for (std::size_t i = 0; i < tools_.size(); ++i) {
    ToolLoad& tool = tools_[i];
    const soil::ToolImpulse& impulse = impulses[i];
    // Forces are means over the last completed transfer; impulses are those of this step.
    tool.impulse = impulse;
    tool.force_W = impulse.force_W;
    tool.moment_W = impulse.moment_W;
    tool.edge_force_W = impulse.edge_force_W;
    tool.smooth_W += blend * (tool.force_W - tool.smooth_W);
    Vec3 rock_W = Vec3::Zero();
    if (const vehicle::RockCapability* rock = engine(tool.machine).rock())
      // The rock acts inside the engine's step, so its force is the impulse over that step.
      rock_W = rock->rock_impulse(index(tool.machine), tool.shell) / dt;
    tool.rock_W += blend * (rock_W - tool.rock_W);
    if (impulse.J_W.squaredNorm() + impulse.L_W.squaredNorm() > 0)
      engine(tool.machine)
          .apply_impulse_of_step(index(tool.machine), tool.link, impulse.J_W, impulse.L_W,
                                 impulse.p_W, dt);
  }
}

// Counts tyres in the order of Ruts, which excludes tracks.
std::vector<soil::SupportArea> Coupling::support_areas(double dt) const {
  std::vector<soil::SupportArea> out;
  // Index of the tyre in Ruts.
  std::size_t tyre = 0;
  for (std::size_t m = 0; m < placed_.size(); ++m) {
    const scene::Machine& machine = world_.machines[m].machine;
    for (std::size_t w = 0; w < machine.wheels.size(); ++w) {
      // Counted for kinematic machines as well: press_ruts passes the tyres of all machines.
      const double load = machine.wheels[w].track ? 0 : ruts_.load(tyre++);
      // Kinematic machines have no weight on the ground.
      if (machine.kinematic) continue;
      add_support_areas(machine, *placed_[m].engine, placed_[m].index, static_cast<int>(w), load,
                        kRutInterval * dt, out);
    }
  }
  return out;
}

// Collects all tyres and tracks before pressing any.
void Coupling::press_ruts(double dt) {
  // Press all at once: what one wheel leaves another may carry.
  std::vector<LoadedTyre> tyres;
  std::vector<terramechanics::TrackPatch> running_tracks;
  for (std::size_t m = 0; m < placed_.size(); ++m) {
    const scene::Machine& machine = world_.machines[m].machine;
    const vehicle::PhysicsEngine& engine = *placed_[m].engine;
    for (std::size_t w = 0; w < machine.wheels.size(); ++w) {
      const int wheel = static_cast<int>(w);
      if (machine.wheels[w].track)
        for (const terramechanics::TrackPatch& patch :
             vehicle::track_patches(engine, placed_[m].index, wheel))
          running_tracks.push_back(patch);
      else
        tyres.push_back({machine.wheels[w], engine.wheel(placed_[m].index, wheel)});
    }
  }
  const double interval = kRutInterval * dt;
  if (!tyres.empty() || !has_tracks_) ruts_.press(tyres, interval);
  if (has_tracks_) track_ruts_.press(running_tracks, kSinkSpeed * interval, tyres.empty());
}

void ToolLoad::visit(Archive& a) {
  // The scene determines which shell it is. Outputs show the values of the last step until the next
  // one.
  a("force_W", force_W);
  a("moment_W", moment_W);
  a("edge_force_W", edge_force_W);
  a("smooth_W", smooth_W);
  a("rock_W", rock_W);
  a("J_W", impulse.J_W);
  a("L_W", impulse.L_W);
  a("J_edge_W", impulse.J_edge_W);
  a("L_edge_W", impulse.L_edge_W);
  a("p_W", impulse.p_W);
  a("normal", impulse.normal);
  a("friction", impulse.friction);
  a("residual", impulse.residual);
  a("residual_moment", impulse.residual_moment);
  a("scale", impulse.scale);
  a("scale_moment", impulse.scale_moment);
}

void Coupling::visit(Archive& a) {
  a.section("coupling", 7, [&] {
    a("steps", steps_);
    a.fixed("tools", tools_);
    a("ruts", ruts_);
  });
}

}  // namespace navvy::coupling
