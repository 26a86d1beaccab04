// SPDX-License-Identifier: Apache-2.0
#include "sim/occupied_areas.h"

#include <array>
#include <cstddef>
#include <functional>
#include <memory>

#include "geometry/oriented_box.h"
#include "sim/start_placing.h"
#include "vehicle/collision_box.h"

namespace navvy::sim {
namespace {

using heightfield::OccupiedArea;

// Eight corners in W; the outline is their convex hull as seen from above.
OccupiedArea area_of(const Pose& X_WL, const geometry::OrientedBox& box, bool machine) {
  const std::array<Vec3, 8> corners = geometry::corners({X_WL * box.X_WO, box.half});
  return heightfield::area_around({corners.begin(), corners.end()}, machine);
}

/// Adds the areas of one machine. `pose` returns X_WL for the index of a link.
void add_areas(const scene::MachineInWorld& placed, const std::function<Pose(std::size_t)>& pose,
               std::vector<OccupiedArea>& out) {
  const scene::Machine& machine = placed.machine;
  const bool driven = is_machine(placed);
  for (std::size_t l = 0; l < machine.links.size(); ++l)
    for (const scene::Collision& collision : machine.links[l].collisions)
      if (const auto box = vehicle::box_of(collision))
        out.push_back(area_of(pose(l), *box, driven));
  for (const scene::Wheel& wheel : machine.wheels)
    if (const auto around = vehicle::box_of(machine, wheel))
      out.push_back(area_of(pose(around->link), around->box, driven));
  for (const scene::Shell& shell : machine.shells) {
    const int link = machine.link_index(shell.link);
    if (link < 0 || shell.vertices.empty()) continue;
    const Pose X_WL = pose(static_cast<std::size_t>(link));
    std::vector<Vec3> points;
    for (const Vec3& v : shell.vertices) points.push_back(X_WL * v);
    out.push_back(heightfield::area_around(points, driven));
  }
}

}  // namespace

bool is_machine(const scene::MachineInWorld& placed) {
  return placed.machine.has_drive || !placed.machine.joints.empty() ||
         !placed.program.steps.empty();
}

std::vector<OccupiedArea> occupied_areas(const scene::Scene& scene, const std::vector<Pose>& X_WB,
                                         const std::vector<char>& included) {
  std::vector<OccupiedArea> out;
  for (std::size_t m = 0; m < scene.machines.size(); ++m) {
    // X_WB holds poses of base links; shapes need those of all links, here with all joints at zero.
    const scene::Machine& machine = scene.machines[m].machine;
    if (included.at(m) == 0 || machine.links.empty()) continue;
    const Pose X_WM = X_WB.at(m) * machine.links[0].X_ML.inverse();
    add_areas(
        scene.machines[m], [&](std::size_t l) { return X_WM * machine.links[l].X_ML; }, out);
  }
  return out;
}

std::vector<OccupiedArea> occupied_areas(const World& world, const std::vector<char>& included) {
  std::vector<OccupiedArea> out;
  const scene::Scene& scene = world.description();
  for (std::size_t m = 0; m < scene.machines.size(); ++m) {
    if (included.at(m) == 0) continue;
    const MachineHandle machine = world.machines().at(static_cast<int>(m));
    add_areas(
        scene.machines[m], [&](std::size_t l) { return machine.link(static_cast<int>(l)).pose(); },
        out);
  }
  return out;
}

heightfield::OccupiedAreas starting_areas(const scene::Scene& scene,
                                          const heightfield::Ground& site,
                                          const std::vector<char>& included) {
  return std::make_shared<const std::vector<OccupiedArea>>(
      occupied_areas(scene, starting_poses(scene, site), included));
}

std::vector<char> all_bodies(const scene::Scene& scene) {
  return std::vector<char>(scene.machines.size(), 1);
}

std::vector<char> fixed_bodies(const scene::Scene& scene) {
  std::vector<char> out;
  for (const scene::MachineInWorld& placed : scene.machines)
    out.push_back(placed.machine.fixed_base && !placed.machine.kinematic && !is_machine(placed));
  return out;
}

// A train of several trailers moves as one.
std::vector<char> bodies_around(const World& world, int machine) {
  const std::vector<scene::Hitch>& hitches = world.description().hitches;
  std::vector<char> out = all_bodies(world.description());
  out.at(static_cast<std::size_t>(machine)) = 0;
  // Exclusion spreads by one hitch in each pass at least, so as many passes as hitches are enough.
  for (std::size_t again = 0; again < hitches.size(); ++again)
    for (std::size_t h = 0; h < hitches.size(); ++h) {
      if (!world.machines().hitch(static_cast<int>(h)).closed) continue;
      char& parent = out.at(static_cast<std::size_t>(hitches[h].parent));
      char& child = out.at(static_cast<std::size_t>(hitches[h].child));
      // A body is left out if the one at the other end of a closed hitch is.
      parent = child = static_cast<char>(parent & child);
    }
  return out;
}

}  // namespace navvy::sim
