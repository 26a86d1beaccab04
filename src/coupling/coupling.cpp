// SPDX-License-Identifier: Apache-2.0
#include "coupling/coupling.h"

#include <algorithm>
#include <cmath>

#include "core/stopwatch.h"
#include "coupling/placing.h"

namespace navvy::coupling {
namespace {

// Fastest sinking of a rut [m/s]: a tyre falling at it adds a tenth to its load; at 1 m/s it passes 0.4 m in the time
// it takes to sink 0.08 m.
constexpr int kPatchInterval = 16;    // steps between looks at the rigid bodies' ground
constexpr double kPatchMargin = 6.0;  // [m] of ground kept around every machine
constexpr int kPatchNodes = 256;      // most nodes along one side of the patch
constexpr int kFarthest = 1 << 29;    // column of a loaded patch: sides and their sums stay numbers
constexpr double kForceCutoff = 3.0;  // [Hz], about v / (2 cell) at 0.6 m/s and 0.1 m

}  // namespace

Coupling::Coupling(const scene::Scene& world, vehicle::Engine& engine, vehicle::Engine& kinematic, soil::Solver& solver,
                   heightfield::Ground& ground)
    : world_(world),
      dynamic_(engine),
      kinematic_(kinematic),
      solver_(solver),
      ground_(ground),
      view_(ground, ground.setup().soils),
      ruts_(ground) {
  for (std::size_t m = 0; m < world.machines.size(); ++m) {
    const scene::MachineInWorld& placed = world.machines[m];
    // Both engines number their machines from 0: who asks for one says its number in the scene.
    vehicle::Engine& mover = placed.machine.kinematic ? kinematic : engine;
    placed_.push_back({&mover, mover.add_machine(placed.machine, place(placed, ground))});
    for (std::size_t s = 0; s < placed.machine.shells.size(); ++s) {
      const scene::Shell& shell = placed.machine.shells[s];
      ToolLoad load;
      load.machine = static_cast<int>(m);
      load.shell = static_cast<int>(s);
      load.link = placed.machine.link_index(shell.link);
      load.tool = solver.add_tool(shell);
      tools_.push_back(load);
    }
  }
  engine.set_rock(ground.datum());
  update_ground_patch();
}

double Coupling::payload(const ToolLoad& tool) const {
  const auto pose = [&](const ToolLoad& t) { return engine(t.machine).link(index(t.machine), t.link).X_WL; };
  const auto machine = [&](const ToolLoad& t) -> const scene::Machine& {
    return world_.machines[static_cast<std::size_t>(t.machine)].machine;
  };
  std::vector<soil::PlacedTool> buckets;  // that may reach into a bed
  if (machine(tool).is_bed(tool.shell))
    for (const ToolLoad& other : tools_)
      if (other.tool != tool.tool && machine(other).is_bucket(other.shell))
        buckets.push_back({other.tool, pose(other)});
  return solver_.payload(tool.tool, pose(tool), buckets);
}

std::vector<std::uint8_t> Coupling::held(std::span<const soil::Particle> particles) const {
  std::vector<soil::PlacedTool> containers;
  for (const ToolLoad& tool : tools_) {
    const scene::Machine& machine = world_.machines[static_cast<std::size_t>(tool.machine)].machine;
    // Soil before a blade lies on the ground, whatever the blade's hull says.
    if (machine.is_bucket(tool.shell) || machine.is_bed(tool.shell))
      containers.push_back({tool.tool, engine(tool.machine).link(index(tool.machine), tool.link).X_WL});
  }
  return solver_.held(particles, containers);
}

void Coupling::step(double dt) {
  if (steps_ % kPatchInterval == 0) {
    const Lap lap(time_share_.ground);
    update_ground_patch();
  }
  // Soil acts over the interval that starts at these poses.
  std::vector<Pose> before;
  before.reserve(tools_.size());
  for (const ToolLoad& tool : tools_) before.push_back(engine(tool.machine).link(index(tool.machine), tool.link).X_WL);
  {
    const Lap lap(time_share_.vehicle);
    if (dynamic_.machine_count() > 0) dynamic_.step(dt, view_);
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
  solver_.step(dt, motions, impulses);
  const double blend = 1 - std::exp(-2 * kPi * kForceCutoff * dt);
  for (std::size_t i = 0; i < tools_.size(); ++i) {
    ToolLoad& tool = tools_[i];
    const soil::ToolImpulse& impulse = impulses[i];
    tool.impulse = impulse;
    tool.force_W = impulse.force_W;
    tool.moment_W = impulse.moment_W;
    tool.smooth_W += blend * (tool.force_W - tool.smooth_W);
    const Vec3 rock = engine(tool.machine).rock_impulse(index(tool.machine), tool.shell) / dt;
    tool.rock_W += blend * (rock - tool.rock_W);
    if (impulse.J_W.squaredNorm() + impulse.L_W.squaredNorm() > 0)
      engine(tool.machine).apply_impulse(index(tool.machine), tool.link, impulse.J_W, impulse.L_W, impulse.p_W);
  }
}

void Coupling::press_ruts(double dt) {
  // All at once: what one wheel does not bear another may.
  std::vector<LoadedTyre> tyres;
  for (std::size_t m = 0; m < placed_.size(); ++m) {
    const scene::Machine& machine = world_.machines[m].machine;
    for (std::size_t w = 0; w < machine.wheels.size(); ++w)
      tyres.push_back({machine.wheels[w], placed_[m].engine->wheel(placed_[m].index, static_cast<int>(w))});
  }
  ruts_.press(tyres, kSinkSpeed * kRutInterval * dt);
}

void Coupling::update_ground_patch() {
  if (dynamic_.machine_count() == 0) return;
  heightfield::CellRect need;
  const double cell = ground_.cell();
  for (const PlacedMachine& machine : placed_) {
    if (machine.engine != &dynamic_) continue;
    const Vec3 p = machine.engine->link(machine.index, 0).X_WL.translation();
    const Vec2i low = ground_.column_at(p.x() - kPatchMargin, p.y() - kPatchMargin);
    const Vec2i high = ground_.column_at(p.x() + kPatchMargin, p.y() + kPatchMargin);
    need.include({low.x(), low.y(), high.x() + 1, high.y() + 1});
  }
  // Asked at every look, so that the next answer is about the time since this one.
  const std::vector<heightfield::CellRect> changed = patch_changes_.take(ground_.view());
  const bool inside = need.x0 >= patch_.x0 && need.y0 >= patch_.y0 && need.x1 <= patch_.x1 && need.y1 <= patch_.y1;
  if (inside) {
    if (std::none_of(changed.begin(), changed.end(), [&](const auto& rect) { return rect.meets(patch_); })) return;
  } else {
    const int margin = static_cast<int>(std::lround(0.5 * kPatchMargin / cell));
    patch_ = {need.x0 - margin, need.y0 - margin, need.x1 + margin, need.y1 + margin};
  }
  const int stride = patch_stride();
  const Vec2i nodes = patch_nodes();
  patch_height_.clear();
  patch_height_.reserve(static_cast<std::size_t>(nodes.x()) * static_cast<std::size_t>(nodes.y()));
  for (int j = 0; j < nodes.y(); ++j)
    for (int i = 0; i < nodes.x(); ++i)
      patch_height_.push_back(
          static_cast<float>(ground_.height(std::clamp(patch_.x0 + i * stride, 0, ground_.nx() - 1),
                                            std::clamp(patch_.y0 + j * stride, 0, ground_.ny() - 1))));
  upload_ground_patch();
}

int Coupling::patch_stride() const {
  // A wide patch (machines far apart) is sampled more coarsely; wheels never use it.
  const int span = std::max(patch_.x1 - patch_.x0, patch_.y1 - patch_.y0);
  return std::max(1, (span + kPatchNodes - 1) / kPatchNodes);
}

Vec2i Coupling::patch_nodes() const {
  const int stride = patch_stride();
  return {(patch_.x1 - patch_.x0) / stride + 1, (patch_.y1 - patch_.y0) / stride + 1};
}

void Coupling::upload_ground_patch() {
  const Vec2i nodes = patch_nodes();
  const Vec2 corner = ground_.origin() + ground_.cell() * Vec2(patch_.x0 + 0.5, patch_.y0 + 0.5);
  dynamic_.set_ground_patch(nodes.x(), nodes.y(), patch_stride() * ground_.cell(), corner, patch_height_);
}

void ToolLoad::visit(Archive& a) {
  // Which shell it is, the scene says. All of the last step is what outputs show until the next one.
  a("force_W", force_W);
  a("moment_W", moment_W);
  a("smooth_W", smooth_W);
  a("rock_W", rock_W);
  a("J_W", impulse.J_W);
  a("L_W", impulse.L_W);
  a("p_W", impulse.p_W);
  a("normal", impulse.normal);
  a("friction", impulse.friction);
  a("residual", impulse.residual);
  a("residual_moment", impulse.residual_moment);
  a("scale", impulse.scale);
  a("scale_moment", impulse.scale_moment);
}

void Coupling::visit_patch(Archive& a) {
  a.ranged("patch_x0", patch_.x0, -kFarthest, kFarthest);
  a.ranged("patch_y0", patch_.y0, -kFarthest, kFarthest);
  a.ranged("patch_x1", patch_.x1, patch_.x0, kFarthest);
  a.ranged("patch_y1", patch_.y1, patch_.y0, kFarthest);
  a("patch_height", patch_height_);
  if (!a.loading()) return;
  // The patch as it was saved, which may be older than the ground; the next look renews it from whatever that is then.
  patch_changes_.forget();
  if (dynamic_.machine_count() == 0) {
    a.require(patch_height_.empty(), "patch_height", "there is ground for rigid bodies, and none in the scene");
    return;
  }
  const Vec2i nodes = patch_nodes();
  const auto expected = static_cast<std::size_t>(nodes.x()) * static_cast<std::size_t>(nodes.y());
  a.require(nodes.minCoeff() >= 2 && patch_height_.size() == expected, "patch_height", "does not fill the patch");
  a.require(std::all_of(patch_height_.begin(), patch_height_.end(), [](float z) { return std::isfinite(z); }),
            "patch_height", "must be finite");
  upload_ground_patch();
}

void Coupling::visit(Archive& a) {
  a.section("coupling", 4, [&] {
    a("steps", steps_);
    visit_patch(a);
    a.fixed("tools", tools_);
    a("ruts", ruts_);
  });
}

}  // namespace navvy::coupling
