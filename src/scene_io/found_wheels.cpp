// SPDX-License-Identifier: Apache-2.0
#include "scene_io/found_wheels.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/scaled_mesh.h"

namespace navvy::scene_io {

namespace {

using Kind = scene::Geometry::Kind;

/// Sets radius and width of a wheel by the points of a mesh; returns false unless they are round
/// about `axis`, a unit vector through `p`.
bool measure_mesh(const scene::Geometry& shape, const Pose& X_MS, const Vec3& axis,
                  FoundWheel& wheel) {
  const Vec3 across = axis.cross(Vec3::UnitZ()).normalized(), up = across.cross(axis);
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const Vec3& v : scene::scaled_mesh(shape).vertices) {
    const Vec3 p = X_MS * v;
    const Vec3 q(p.dot(axis), p.dot(across), p.dot(up));
    low = low.cwiseMin(q);
    high = high.cwiseMax(q);
  }
  const Vec3 size = high - low;
  if (!size.allFinite() || std::abs(size.y() - size.z()) > 0.05 * size.z()) return false;
  const Vec3 middle = 0.5 * (low + high);
  wheel.p_MW = middle.x() * axis + middle.y() * across + middle.z() * up;
  wheel.radius = 0.5 * size.z();
  wheel.width = size.x();
  return wheel.radius > 0;
}

/// Sets the size of a wheel by one shape of its link; returns false for a shape that does not roll.
bool measure(const scene::Geometry& shape, const Pose& X_MS, const Vec3& axis, FoundWheel& wheel) {
  wheel.p_MW = X_MS.translation();
  wheel.radius = shape.radius;
  wheel.width = shape.length;
  if (shape.kind == Kind::kMesh) return measure_mesh(shape, X_MS, axis, wheel);
  if (shape.kind == Kind::kCylinder) return std::abs(X_MS.linear().col(2).dot(axis)) > 0.99;
  // A ball touches on a narrow strip.
  wheel.width = 0.4 * shape.radius;
  return shape.kind == Kind::kSphere;
}

/// Finds out what turns the carrier of a wheel about the vertical.
void find_steering(const scene::Machine& machine, const scene::Joint& spin, FoundWheel& wheel) {
  if (spin.parent <= 0) return;
  const int index = spin.parent - 1;
  const scene::Joint& above = machine.joints[static_cast<std::size_t>(index)];
  if (above.type != scene::Joint::Type::kRevolute) return;
  const Vec3 axis =
      (machine.links[static_cast<std::size_t>(above.child)].X_ML * above.X_LcJ).linear() *
      above.axis;
  if (std::abs(axis.z()) < 0.9) return;
  (above.has_limits ? wheel.steer : wheel.swivel) = index;
}

/// Decides which wheels that swivel are casters: those without a steered wheel on the other side.
void find_casters(std::vector<FoundWheel>& wheels) {
  for (FoundWheel& wheel : wheels) {
    if (wheel.swivel < 0) continue;
    const bool beside_steered =
        std::any_of(wheels.begin(), wheels.end(), [&](const FoundWheel& other) {
          return other.steer >= 0 && other.swivel < 0 &&
                 std::abs(other.p_MW.x() - wheel.p_MW.x()) < wheel.radius &&
                 other.p_MW.y() * wheel.p_MW.y() < 0;
        });
    if (beside_steered)
      wheel.steer = wheel.swivel;
    else
      wheel.caster = true;
  }
}

}  // namespace

std::vector<FoundWheel> find_wheels(const scene::Machine& machine) {
  std::vector<FoundWheel> wheels;
  for (std::size_t j = 0; j < machine.joints.size(); ++j) {
    const scene::Joint& joint = machine.joints[j];
    if (joint.type != scene::Joint::Type::kRevolute || joint.has_limits || joint.parent < 0)
      continue;
    const scene::Link& link = machine.links[static_cast<std::size_t>(joint.child)];
    const Vec3 axis = (link.X_ML * joint.X_LcJ).linear() * joint.axis;
    if (std::abs(axis.y()) < 0.994) continue;
    FoundWheel wheel;
    wheel.joint = static_cast<int>(j);
    wheel.points_right = axis.y() < 0;
    bool round = false;
    for (const scene::Collision& shape : link.collisions)
      if (!round && (round = measure(shape.geometry, link.X_ML * shape.X_LC, axis, wheel)))
        wheel.friction = shape.friction;
    if (link.collisions.empty())
      for (const scene::Visual& shape : link.visuals)
        round = round || measure(shape.geometry, link.X_ML * shape.X_LV, axis, wheel);
    if (!round) continue;
    find_steering(machine, joint, wheel);
    wheels.push_back(wheel);
  }
  double lowest = std::numeric_limits<double>::infinity();
  for (const FoundWheel& wheel : wheels) lowest = std::min(lowest, wheel.p_MW.z() - wheel.radius);
  std::erase_if(wheels, [&](const FoundWheel& wheel) {
    return wheel.p_MW.z() - wheel.radius > lowest + 0.3 * wheel.radius;
  });
  find_casters(wheels);
  return wheels;
}

}  // namespace navvy::scene_io
