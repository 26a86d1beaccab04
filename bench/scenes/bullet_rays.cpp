// SPDX-License-Identifier: Apache-2.0
#include "bullet_rays.h"

#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <btBulletCollisionCommon.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "sensor/shape_mesh.h"

namespace navvy::bench {
namespace {

btVector3 to_bullet(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

btTransform to_bullet(const Pose& X) {
  const Eigen::Quaterniond q(X.linear());
  return btTransform(btQuaternion(q.x(), q.y(), q.z(), q.w()), to_bullet(X.translation()));
}

}  // namespace

struct BulletRays::State {
  void add(std::unique_ptr<btCollisionShape> shape, const btTransform& at) {
    add(shape.get(), at);
    shapes.push_back(std::move(shape));
  }
  void add(btCollisionShape* shape, const btTransform& at) {
    auto object = std::make_unique<btCollisionObject>();
    object->setCollisionShape(shape);
    object->setWorldTransform(at);
    world.addCollisionObject(object.get());
    objects.push_back(std::move(object));
  }
  void add_machines(const sim::World& from);
  void add_ground(const heightfield::TerrainView& ground);

  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btCollisionWorld world{&dispatcher, &broadphase, &configuration};
  std::vector<std::unique_ptr<btTriangleMesh>> meshes;
  std::vector<std::unique_ptr<btCollisionShape>> shapes;
  std::vector<std::unique_ptr<btCollisionObject>> objects;
  std::vector<double> heights;
};

void BulletRays::State::add_machines(const sim::World& from) {
  const auto& machines = from.description().machines;
  for (std::size_t m = 0; m < machines.size(); ++m)
    for (std::size_t l = 0; l < machines[m].machine.links.size(); ++l) {
      geometry::TriangleMesh look;
      for (const scene::Visual& visual : machines[m].machine.links[l].visuals)
        sensor::append(sensor::mesh_of(visual.geometry), visual.X_LV, look);
      if (look.triangles.empty()) continue;
      auto mesh = std::make_unique<btTriangleMesh>();
      for (std::size_t t = 0; t < look.triangles.size(); ++t)
        mesh->addTriangle(to_bullet(look.corner(t, 0)), to_bullet(look.corner(t, 1)),
                          to_bullet(look.corner(t, 2)));
      add(std::make_unique<btBvhTriangleMeshShape>(mesh.get(), true),
          to_bullet(from.machines().at(static_cast<int>(m)).link(static_cast<int>(l)).pose()));
      meshes.push_back(std::move(mesh));
    }
}

void BulletRays::State::add_ground(const heightfield::TerrainView& ground) {
  for (int iy = 0; iy < ground.ny(); ++iy)
    for (int ix = 0; ix < ground.nx(); ++ix) heights.push_back(ground.height(ix, iy));
  const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
  auto shape = std::make_unique<btHeightfieldTerrainShape>(ground.nx(), ground.ny(), heights.data(),
                                                           *low - 1, *high + 1, 2, false);
  shape->setLocalScaling({ground.cell(), ground.cell(), 1});
  shape->buildAccelerator();
  // Bullet puts the middle of the grid and of its range of heights at the origin.
  const Vec2 middle = ground.origin() + 0.5 * ground.cell() * Vec2(ground.nx(), ground.ny());
  add(std::move(shape),
      btTransform(btQuaternion::getIdentity(), {middle.x(), middle.y(), 0.5 * (*low + *high)}));
}

BulletRays::BulletRays(const sim::World& world, const sim::VisibleSoil& soil)
    : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.add_machines(world);
  s.add_ground(soil.surface());
  // Particles differ little in size: one shape for all that are equal.
  float radius = -1;
  for (const sim::SoilBall& ball : soil.balls()) {
    const btTransform at(btQuaternion::getIdentity(),
                         to_bullet(soil.origin() + ball.p_O.cast<double>()));
    if (ball.radius != radius) {
      radius = ball.radius;
      s.add(std::make_unique<btSphereShape>(static_cast<double>(radius)), at);
    } else {
      s.add(s.shapes.back().get(), at);
    }
  }
  update();
}

BulletRays::~BulletRays() {
  for (const auto& object : state_->objects) state_->world.removeCollisionObject(object.get());
}

void BulletRays::update() { state_->world.updateAabbs(); }

double BulletRays::first_hit(const Vec3& p_W, const Vec3& direction_W, double reach) const {
  const btVector3 from = to_bullet(p_W), to = to_bullet(p_W + reach * direction_W);
  btCollisionWorld::ClosestRayResultCallback callback(from, to);
  state_->world.rayTest(from, to, callback);
  return callback.hasHit() ? reach * callback.m_closestHitFraction : -1;
}

}  // namespace navvy::bench
