// SPDX-License-Identifier: Apache-2.0
#include "sim/cylinder_shapes.h"

#include "vehicle/kinematics.h"

namespace navvy::sim {
namespace {

constexpr double kLinkageAside = 0.20;  // distance of a bucket linkage's bars from its middle [m]
constexpr double kBarRadius = 0.05;     // [m]

/// Adds a cylinder of the machine with index `m`, and the bars of its linkage if it has one.
void add_cylinder(const World& world, int m, const scene::Cylinder& cylinder,
                  std::vector<scene::FrameCylinder>& out) {
  const scene::Machine& machine = world.description().machines[static_cast<std::size_t>(m)].machine;
  const int joint = machine.joint_index(cylinder.joint),
            base = machine.link_index(cylinder.base_link),
            rod = machine.link_index(cylinder.rod_link);
  if (joint < 0 || base < 0 || rod < 0) return;
  // The pins follow from the joint's angle; a cylinder has no state of its own.
  const auto geometry =
      vehicle::cylinder_geometry(machine, cylinder, world.machines().at(m).joint(joint).position());
  const Pose X_WL = world.machines().at(m).link(base).pose();
  const auto add = [&](const Vec3& from, const Vec3& to, double radius, double barrel,
                       double aside) {
    const Vec3 shift = X_WL.linear() * Vec3(0, aside, 0);
    out.push_back({from + shift, to + shift, radius, barrel});
  };
  // All `count` cylinders stand side by side.
  for (int i = 0; i < cylinder.count; ++i)
    add(X_WL * geometry.p_base, X_WL * geometry.p_rod, 0.6 * cylinder.bore, 0.55 * geometry.length,
        cylinder.spacing * (i - 0.5 * (cylinder.count - 1)));
  if (!cylinder.has_linkage) return;
  // Rocker and coupler on both sides; rod pin and coupler pin are on one ray from the rocker's
  // pivot.
  const Vec3 pin = cylinder.p_rocker + cylinder.rocker_coupler / cylinder.rocker_rod *
                                           (geometry.p_rod - cylinder.p_rocker);
  const Vec3 on_bucket = world.machines().at(m).link(rod).pose() * cylinder.p_coupler;
  for (const double aside : {-kLinkageAside, kLinkageAside}) {
    add(X_WL * cylinder.p_rocker, X_WL * pin, kBarRadius, cylinder.rocker_coupler, aside);
    add(X_WL * pin, on_bucket, kBarRadius, cylinder.coupler, aside);
  }
}

}  // namespace

void add_cylinder_shapes(const World& world, int machine, std::vector<scene::FrameCylinder>& out) {
  const auto& machines = world.description().machines;
  for (const scene::Cylinder& one : machines[static_cast<std::size_t>(machine)].machine.cylinders)
    add_cylinder(world, machine, one, out);
}

}  // namespace navvy::sim
