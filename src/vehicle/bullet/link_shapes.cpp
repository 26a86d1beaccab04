// SPDX-License-Identifier: Apache-2.0
#include "vehicle/bullet/link_shapes.h"

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btBvhTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btConeShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/CollisionShapes/btTriangleMesh.h>

#include <algorithm>
#include <string>

#include "core/error.h"
#include "geometry/read_mesh.h"
#include "vehicle/bullet/convert.h"

namespace navvy::vehicle {
namespace {

[[noreturn]] void refuse(const scene::Collision& collision, const std::string& value,
                         const std::string& rule) {
  Fault fault;
  fault.element = "collision[" + collision.name + "]";
  fault.value = value;
  fault.rule = rule;
  throw InputError(fault);
}

/// Returns the convex hull of the vertices of an OBJ file, whether faces use them or not.
std::unique_ptr<btCollisionShape> make_hull(const scene::Collision& collision) {
  const scene::Geometry& g = collision.geometry;
  auto hull = std::make_unique<btConvexHullShape>();
  for (const Vec3& v : geometry::read_mesh(g.mesh_file).vertices)
    // false: the box around the shape is computed once, after the last point.
    hull->addPoint(to_bt(Vec3(g.scale.cwiseProduct(v))), false);
  if (hull->getNumPoints() < 4)
    refuse(collision, g.mesh_file, "the mesh needs at least four vertices");
  hull->optimizeConvexHull();
  hull->recalcLocalAabb();
  return hull;
}

/// Returns the triangles of a mesh that never moves, two-sided. The shape reads them from `keep`.
std::unique_ptr<btCollisionShape> make_triangles(
    const scene::Collision& collision,
    std::vector<std::unique_ptr<btStridingMeshInterface>>& keep) {
  const scene::Geometry& g = collision.geometry;
  const geometry::TriangleMesh mesh = geometry::read_mesh(g.mesh_file);
  // 32-bit indices, vertices of three components.
  auto triangles = std::make_unique<btTriangleMesh>(true, false);
  const auto corner = [&](std::size_t t, std::size_t i) {
    return to_bt(Vec3(g.scale.cwiseProduct(mesh.corner(t, i))));
  };
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    triangles->addTriangle(corner(t, 0), corner(t, 1), corner(t, 2));
  if (mesh.triangles.empty()) refuse(collision, g.mesh_file, "the mesh has no triangle");
  keep.push_back(std::move(triangles));
  return std::make_unique<btBvhTriangleMeshShape>(keep.back().get(), true);
}

std::unique_ptr<btCollisionShape> make_shape(
    const scene::Collision& collision, bool stands,
    std::vector<std::unique_ptr<btStridingMeshInterface>>& keep) {
  using Kind = scene::Geometry::Kind;
  const scene::Geometry& g = collision.geometry;
  switch (g.kind) {
    case Kind::kBox:
      return std::make_unique<btBoxShape>(to_bt(Vec3(0.5 * g.size)));
    case Kind::kCylinder:
      return std::make_unique<btCylinderShapeZ>(btVector3(g.radius, g.radius, 0.5 * g.length));
    case Kind::kSphere:
      return std::make_unique<btSphereShape>(g.radius);
    case Kind::kCone:
      // Bullet's cone is centred at half its height, like SDF's.
      return std::make_unique<btConeShapeZ>(g.radius, g.length);
    case Kind::kCapsule:
      return std::make_unique<btCapsuleShapeZ>(g.radius, g.length);
    case Kind::kMesh:
      return stands ? make_triangles(collision, keep) : make_hull(collision);
    case Kind::kPlane:
      break;
  }
  refuse(collision, "plane",
         "a link cannot collide as a plane; a plane in a scene is the rock under the ground");
}

/// Returns the smallest width of a convex shape [m], the least over 13 directions.
double width_of(const btConvexShape& shape) {
  double least = std::numeric_limits<double>::infinity();
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z) {
        if (x == 0 && y == 0 && z == 0) continue;
        const btVector3 d = btVector3(x, y, z).normalized();
        least = std::min(least, static_cast<double>(d.dot(shape.localGetSupportingVertex(d) -
                                                          shape.localGetSupportingVertex(-d))));
      }
  return least;
}

/// Friction of a shell's steel against bodies without a material (U): about 0.5 on a stone with the
/// usual 0.8.
constexpr double kSteelFriction = 0.6;

}  // namespace

// One convex hull per triangle.
LinkShape make_steel(const scene::Shell& shell) {
  LinkShape out;
  out.compound = std::make_unique<btCompoundShape>();
  out.friction = kSteelFriction;
  out.thinnest = 2 * shell.half_thickness;
  for (std::size_t t = 0; t < shell.triangles.size(); ++t) {
    auto plate = std::make_unique<btConvexHullShape>();
    for (std::size_t i = 0; i < 3; ++i) plate->addPoint(to_bt(shell.corner(t, i)), false);
    // The margin is the plate's half thickness, so the hull of the middle plane becomes the plate.
    plate->setMargin(shell.half_thickness);
    plate->recalcLocalAabb();
    out.compound->addChildShape(btTransform::getIdentity(), plate.get());
    out.parts.push_back(std::move(plate));
  }
  return out;
}

// The largest friction of the parts applies to the link.
LinkShape make_link_shape(const scene::Link& link, const Pose& X_IL, bool stands) {
  LinkShape out;
  if (link.collisions.empty()) return out;
  out.compound = std::make_unique<btCompoundShape>();
  out.friction = 0;
  for (const scene::Collision& collision : link.collisions) {
    out.parts.push_back(make_shape(collision, stands, out.meshes));
    // Bullet's default margin, 4 cm, is too coarse for small parts.
    out.parts.back()->setMargin(std::min(0.02, out.parts.back()->getMargin()));
    out.compound->addChildShape(to_bt(Pose(X_IL * collision.X_LC)), out.parts.back().get());
    out.friction = std::max(out.friction, collision.friction);
    if (out.parts.back()->isConvex())
      out.thinnest =
          std::min(out.thinnest, width_of(static_cast<const btConvexShape&>(*out.parts.back())));
  }
  return out;
}

}  // namespace navvy::vehicle
