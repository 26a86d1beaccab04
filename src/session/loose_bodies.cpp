// SPDX-License-Identifier: Apache-2.0
#include "session/loose_bodies.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <optional>

#include "geometry/oriented_box.h"
#include "vehicle/collision_box.h"

namespace navvy::session {
namespace {

/// Returns true if the machine with this index is a loose body.
bool is_loose(const scene::Scene& scene, std::size_t machine) {
  const scene::MachineInWorld& placed = scene.machines[machine];
  const scene::Machine& one = placed.machine;
  const auto index = static_cast<int>(machine);
  const bool hitched =
      std::any_of(scene.hitches.begin(), scene.hitches.end(),
                  [&](const auto& hitch) { return hitch.parent == index || hitch.child == index; });
  return one.links.size() == 1 && one.joints.empty() && !one.fixed_base && !one.kinematic &&
         !one.has_drive && placed.program.steps.empty() && !hitched;
}

/// Returns the box around the shapes of the only link of a body, in the frame of the link.
Eigen::AlignedBox3d box_around(const scene::Machine& body) {
  Eigen::AlignedBox3d out;
  for (const scene::Collision& collision : body.links[0].collisions)
    if (const std::optional<geometry::OrientedBox> box = vehicle::box_of(collision))
      for (const Vec3& corner : geometry::corners(*box)) out.extend(corner);
  for (const scene::Shell& shell : body.shells)
    for (const Vec3& v : shell.vertices) out.extend(v);
  return out;
}

}  // namespace

LooseBodies::LooseBodies(const scene::Scene& scene) {
  for (std::size_t m = 0; m < scene.machines.size(); ++m) {
    if (!is_loose(scene, m)) continue;
    const Eigen::AlignedBox3d box = box_around(scene.machines[m].machine);
    if (box.isEmpty()) continue;
    Body body;
    body.machine = m;
    body.middle_L = box.center();
    body.view.name = scene.machines[m].name;
    body.view.largest = box.sizes().maxCoeff();
    body.view.smallest = box.sizes().minCoeff();
    body.view.has_shell = !scene.machines[m].machine.shells.empty();
    body.view.mass = scene.machines[m].machine.total_mass();
    bodies_.push_back(body);
  }
}

std::vector<control::BodyView> LooseBodies::at(const std::vector<Pose>& X_WB) const {
  std::vector<control::BodyView> out;
  for (const Body& body : bodies_) {
    out.push_back(body.view);
    out.back().centre = X_WB.at(body.machine) * body.middle_L;
  }
  return out;
}

std::vector<control::BodyView> LooseBodies::in(const sim::World& world) const {
  std::vector<control::BodyView> out;
  for (const Body& body : bodies_) {
    const vehicle::LinkState link =
        world.machines().at(static_cast<int>(body.machine)).link(0).state();
    out.push_back(body.view);
    out.back().centre = link.X_WL * body.middle_L;
    out.back().speed = link.v_WL.norm();
  }
  return out;
}

}  // namespace navvy::session
