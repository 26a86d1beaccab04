// SPDX-License-Identifier: Apache-2.0
#include "vehicle/collision_box.h"

#include <Eigen/Eigenvalues>

#include "core/error.h"
#include "geometry/primitive_solids.h"
#include "geometry/read_mesh.h"
#include "geometry/triangle_mesh.h"

namespace navvy::vehicle {

// Round shapes take the box around them.
std::optional<geometry::OrientedBox> box_of(const scene::Collision& collision) {
  const scene::Geometry& g = collision.geometry;
  geometry::OrientedBox box{collision.X_LC, Vec3::Zero()};
  switch (g.kind) {
    case scene::Geometry::Kind::kBox:
      box.half = 0.5 * g.size;
      return box;
    case scene::Geometry::Kind::kCylinder:
    case scene::Geometry::Kind::kCone:
      box.half = Vec3(g.radius, g.radius, 0.5 * g.length);
      return box;
    case scene::Geometry::Kind::kCapsule:
      box.half = Vec3(g.radius, g.radius, 0.5 * g.length + g.radius);
      return box;
    case scene::Geometry::Kind::kSphere:
      box.half = Vec3::Constant(g.radius);
      return box;
    // A plane is the rock under the ground and has no box.
    case scene::Geometry::Kind::kPlane:
      return std::nullopt;
    case scene::Geometry::Kind::kMesh:
      break;
  }
  try {
    const geometry::Box round = geometry::bounds(geometry::read_mesh(g.mesh_file));
    // The middle of the bounds is scaled with the mesh; the half edges need the size of the scale
    // only.
    box.X_WO =
        collision.X_LC * Eigen::Translation3d(0.5 * (round.low + round.high).cwiseProduct(g.scale));
    box.half = 0.5 * (round.high - round.low).cwiseProduct(g.scale.cwiseAbs());
    return box;
  } catch (const Error&) {
    // The reader of the scene reports a mesh that cannot be read; here it has no box.
    return std::nullopt;
  }
}

// Moments in ascending order are compared, as the link's axes need not be those of the boxes.
InertiaShare inertia_share(const scene::Link& link) {
  std::optional<geometry::SolidProperties> solid;
  for (const scene::Collision& collision : link.collisions)
    if (const std::optional<geometry::OrientedBox> box = box_of(collision)) {
      const geometry::SolidProperties part =
          geometry::placed(geometry::solid_box(2 * box->half), box->X_WO);
      solid = solid ? geometry::joined(*solid, part) : part;
    }
  InertiaShare out;
  if (!solid || !(solid->volume > 0) || !(link.mass > 0)) return out;
  const auto moments = [](const Mat3& inertia) {
    return Vec3(Eigen::SelfAdjointEigenSolver<Mat3>(inertia, Eigen::EigenvaluesOnly).eigenvalues());
  };
  const Vec3 own = moments(link.inertia),
             expected = moments(solid->inertia * (link.mass / solid->volume));
  for (int i = 0; i < 3; ++i)
    if (own[i] < out.share * expected[i]) out = {own[i] / expected[i], own[i], expected[i]};
  return out;
}

std::optional<WheelBox> box_of(const scene::Machine& machine, const scene::Wheel& wheel) {
  const int joint = machine.joint_index(wheel.joint);
  if (joint < 0) return std::nullopt;
  // Twin tyres are one body from outer side to outer side.
  const double width = wheel.width + wheel.twin_spacing;
  return WheelBox{static_cast<std::size_t>(machine.joints[static_cast<std::size_t>(joint)].child),
                  {Pose::Identity(), Vec3(wheel.radius, width / 2, wheel.radius)}};
}

}  // namespace navvy::vehicle
