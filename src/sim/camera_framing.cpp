// SPDX-License-Identifier: Apache-2.0
#include "sim/camera_framing.h"

#include <algorithm>
#include <cmath>

#include "heightfield/terrain_view.h"
#include "scene/forward_kinematics.h"
#include "sim/occupied_areas.h"
#include "sim/start_placing.h"
#include "sim/world_terrain.h"
#include "vehicle/collision_box.h"

namespace navvy::sim {
namespace {

using Framed = scene::Camera::Framed;

// Part of the picture, from its middle to each side, that the framed points may cover.
constexpr double kUsed = 0.9;
// Height over the ground, at the place of a step, that stays in the picture [m].
constexpr double kHeadroom = 1;

void add_corners(const Pose& X_WL, const geometry::OrientedBox& box, std::vector<Vec3>& out) {
  for (const Vec3& corner : geometry::corners({X_WL * box.X_WO, box.half})) out.push_back(corner);
}

/// Adds the places of a machine's program, with half the machine's width around them.
void add_program(const heightfield::TerrainView& terrain, const scene::Program& program,
                 double half_width, std::vector<Vec3>& out) {
  for (const scene::ProgramStep& step : program.steps)
    for (const Vec2& place : step->places()) {
      const Vec2i at = terrain.column_at(place.x(), place.y());
      const double ground = terrain.start_height(std::clamp(at.x(), 0, terrain.nx() - 1),
                                                 std::clamp(at.y(), 0, terrain.ny() - 1));
      for (const double x : {-half_width, half_width})
        for (const double y : {-half_width, half_width})
          for (const double z : {0.0, kHeadroom})
            out.push_back({place.x() + x, place.y() + y, ground + z});
    }
}

}  // namespace

CameraFraming::CameraFraming(const World& world) : world_(world) {
  const scene::Scene& scene = world.description();
  const auto framed = [&scene](Framed what) {
    return std::any_of(scene.cameras.begin(), scene.cameras.end(),
                       [what](const scene::Camera& one) { return one.frame == what; });
  };
  if (!framed(Framed::kMachine) && !framed(Framed::kProgram) && !framed(Framed::kAll)) return;
  for (const scene::MachineInWorld& placed : scene.machines)
    parts_.push_back(shape_boxes(placed.machine));
  if (framed(Framed::kProgram)) add_start(false, program_);
  if (framed(Framed::kAll)) add_start(true, all_);
}

std::vector<ShapeBox> shape_boxes(const scene::Machine& machine) {
  std::vector<ShapeBox> out;
  const auto add = [&out](std::size_t link, const scene::Geometry& shape, const Pose& X_LS) {
    scene::Collision body;
    body.geometry = shape;
    body.X_LC = X_LS;
    if (const auto box = vehicle::box_of(body)) out.push_back({static_cast<int>(link), *box});
  };
  for (std::size_t l = 0; l < machine.links.size(); ++l) {
    for (const scene::Visual& one : machine.links[l].visuals) add(l, one.geometry, one.X_LV);
    for (const scene::Collision& one : machine.links[l].collisions) add(l, one.geometry, one.X_LC);
  }
  for (const scene::Wheel& wheel : machine.wheels)
    if (const auto around = vehicle::box_of(machine, wheel))
      out.push_back({static_cast<int>(around->link), around->box});
  return out;
}

std::vector<Vec3> CameraFraming::points(const scene::Camera& camera) const {
  if (camera.frame == Framed::kProgram) return program_;
  if (camera.frame == Framed::kAll) return all_;
  std::vector<Vec3> out;
  const scene::Scene& scene = world_.description();
  for (std::size_t m = 0; camera.frame == Framed::kMachine && m < scene.machines.size(); ++m) {
    const bool chosen = camera.machine.empty() ? is_machine(scene.machines[m])
                                               : scene.machines[m].name == camera.machine;
    if (!chosen) continue;
    const MachineHandle machine = world_.machines().at(static_cast<int>(m));
    for (const ShapeBox& part : parts_[m])
      add_corners(machine.link(part.link).pose(), part.box, out);
  }
  return out;
}

void CameraFraming::add_start(bool bodies, std::vector<Vec3>& out) const {
  const scene::Scene& scene = world_.description();
  const heightfield::TerrainView terrain = terrain_view(world_, heightfield::SurfaceKind::kColumns);
  const std::vector<Pose> X_WB = starting_poses(scene, world_.ground());
  for (std::size_t m = 0; m < scene.machines.size(); ++m) {
    const scene::Machine& machine = scene.machines[m].machine;
    if (!bodies && !is_machine(scene.machines[m])) continue;
    if (machine.links.empty()) continue;
    const std::size_t before = out.size();
    const std::vector<Pose> X_WL = scene::forward_kinematics(machine, X_WB[m], {});
    for (const ShapeBox& part : parts_[m])
      add_corners(X_WL[static_cast<std::size_t>(part.link)], part.box, out);
    Vec2 low = Vec2::Constant(1e30), high = -low;
    for (std::size_t i = before; i < out.size(); ++i) {
      low = low.cwiseMin(out[i].head<2>());
      high = high.cwiseMax(out[i].head<2>());
    }
    const double width = std::max(0.0, (high - low).minCoeff());
    add_program(terrain, scene.machines[m].program, 0.5 * width, out);
  }
}

// The side planes through the camera bound its place: for each point, cz >= z + |x - cx| / tan, in
// the camera's axes. The lowest cz is where the tightest plane of the left side and that of the
// right side meet, and likewise for top and bottom.
void frame_points(const std::vector<Vec3>& points, scene::FrameCamera& camera) {
  if (points.empty()) return;
  const double tan_x = kUsed * std::tan(0.5 * camera.fov);
  const Vec2 tangent(tan_x, tan_x * camera.height / camera.width);
  const Mat3 R_CW = camera.X_WC.linear().transpose();
  Vec2 right = Vec2::Constant(-1e30), left = right;
  for (const Vec3& p_W : points) {
    const Vec3 p = R_CW * p_W;
    for (int i = 0; i < 2; ++i) {
      right[i] = std::max(right[i], p.z() + p[i] / tangent[i]);
      left[i] = std::max(left[i], p.z() - p[i] / tangent[i]);
    }
  }
  const Vec2 middle = 0.5 * tangent.cwiseProduct(right - left);
  const double back = 0.5 * (right + left).maxCoeff();
  camera.X_WC.translation() = camera.X_WC.linear() * Vec3(middle.x(), middle.y(), back);
}

}  // namespace navvy::sim
