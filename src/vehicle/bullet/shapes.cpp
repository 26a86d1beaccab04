// SPDX-License-Identifier: Apache-2.0
#include "vehicle/bullet/shapes.h"

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>

#include <algorithm>
#include <string>

#include "core/error.h"
#include "geometry/obj/read_obj.h"
#include "vehicle/bullet/convert.h"

namespace navvy::vehicle {
namespace {

[[noreturn]] void refuse(const scene::Collision& collision, const std::string& value, const std::string& rule) {
  Fault fault;
  fault.element = "collision[" + collision.name + "]";
  fault.value = value;
  fault.rule = rule;
  throw InputError(fault);
}

/// Convex hull of the vertices of an OBJ file, whether faces use them or not.
std::unique_ptr<btCollisionShape> make_hull(const scene::Collision& collision) {
  const scene::Geometry& g = collision.geometry;
  auto hull = std::make_unique<btConvexHullShape>();
  for (const Vec3& v : geometry::read_obj(g.mesh_file).vertices)
    hull->addPoint(to_bt(Vec3(g.scale.cwiseProduct(v))), false);
  if (hull->getNumPoints() < 4) refuse(collision, g.mesh_file, "the mesh needs at least four vertices");
  hull->optimizeConvexHull();
  hull->recalcLocalAabb();
  return hull;
}

std::unique_ptr<btCollisionShape> make_shape(const scene::Collision& collision) {
  using Kind = scene::Geometry::Kind;
  const scene::Geometry& g = collision.geometry;
  switch (g.kind) {
    case Kind::kBox:
      return std::make_unique<btBoxShape>(to_bt(Vec3(0.5 * g.size)));
    case Kind::kCylinder:
      return std::make_unique<btCylinderShapeZ>(btVector3(g.radius, g.radius, 0.5 * g.length));
    case Kind::kSphere:
      return std::make_unique<btSphereShape>(g.radius);
    case Kind::kMesh:
      return make_hull(collision);
    case Kind::kPlane:
      break;
  }
  refuse(collision, "plane", "a moving link cannot collide as a plane");
}

}  // namespace

LinkShape make_link_shape(const scene::Link& link, const Pose& X_IL) {
  LinkShape out;
  if (link.collisions.empty()) return out;
  out.compound = std::make_unique<btCompoundShape>();
  out.friction = 0;
  for (const scene::Collision& collision : link.collisions) {
    out.parts.push_back(make_shape(collision));
    out.parts.back()->setMargin(std::min(0.02, out.parts.back()->getMargin()));
    out.compound->addChildShape(to_bt(Pose(X_IL * collision.X_LC)), out.parts.back().get());
    out.friction = std::max(out.friction, collision.friction);
  }
  return out;
}

GroundPatch::GroundPatch(int nx, int ny, double spacing, const Vec2& corner, const std::vector<float>& heights) {
  const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
  const double middle = 0.5 * (static_cast<double>(*low) + static_cast<double>(*high));
  height.reserve(heights.size());
  for (const float h : heights) height.push_back(static_cast<double>(h) - middle);
  const double range = 0.5 * (static_cast<double>(*high) - static_cast<double>(*low)) + 0.05;
  shape = std::make_unique<btHeightfieldTerrainShape>(nx, ny, height.data(), -range, range, 2, false);
  shape->setLocalScaling(btVector3(spacing, spacing, 1));
  // Bullet puts the origin into the middle of the grid.
  center = Vec3(corner.x() + 0.5 * spacing * (nx - 1), corner.y() + 0.5 * spacing * (ny - 1), middle);
}

}  // namespace navvy::vehicle
