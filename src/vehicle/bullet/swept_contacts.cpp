// SPDX-License-Identifier: Apache-2.0
#include "vehicle/bullet/swept_contacts.h"

#include <BulletCollision/CollisionDispatch/btManifoldResult.h>
#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletCollision/CollisionShapes/btConvexShape.h>
#include <LinearMath/btTransformUtil.h>

#include <algorithm>

#include "vehicle/bullet/bullet_machine.h"
#include "vehicle/bullet/convert.h"

namespace navvy::vehicle {
namespace {

/// Margin of a stretched box [m], that of Bullet's own boxes.
constexpr double kMargin = 0.02;
/// Corners nearer than this are one [m].
constexpr double kSame = 1e-6;
/// Half of the thinnest side below which a body is thin [m]: the triangles of the ground do not
/// carry it at rest, as they are as thin as its overlap with them.
constexpr double kThin = 0.005;
/// Halvings of the interval in which a corner meets the ground.
constexpr int kHalvings = 24;

/// Velocity of a collision object: that of its origin [m/s], and its angular velocity [rad/s], in
/// W.
struct Velocity {
  Vec3 v = Vec3::Zero(), w = Vec3::Zero();
};

Velocity velocity_of(const btCollisionObject& object) {
  const auto* machine = static_cast<const BulletMachine*>(object.getUserPointer());
  if (machine == nullptr) return {};
  const LinkState link = machine->tree().link(object.getUserIndex());
  const Vec3 origin = to_eigen(object.getWorldTransform().getOrigin());
  return {link.v_WL + link.w_WL.cross(origin - link.X_WL.translation()), link.w_WL};
}

/// Returns the farthest way of any point of an object in a step [m].
double travel_of(const btCollisionObject& object, const Velocity& velocity, double dt) {
  return dt * (velocity.v.norm() + velocity.w.norm() * object.getCcdSweptSphereRadius());
}

/// Pose of a collision object at the start and the end of a step, as its velocity predicts it.
struct Motion {
  btTransform from, to;
};

Motion motion_of(const btCollisionObject& object, const Velocity& velocity, double dt) {
  Motion out{object.getWorldTransform(), object.getWorldTransform()};
  if (velocity.v.isZero(0) && velocity.w.isZero(0)) return out;
  btTransformUtil::integrateTransform(out.from, to_bt(velocity.v), to_bt(velocity.w), dt, out.to);
  return out;
}
Motion motion_of(const btCollisionObject& object, double dt) {
  return motion_of(object, velocity_of(object), dt);
}

/// Returns the corners of a shape in its own frame: its farthest points in 26 directions.
std::vector<btVector3> corners_of(const btConvexShape& shape) {
  std::vector<btVector3> out;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z) {
        if (x == 0 && y == 0 && z == 0) continue;
        const btVector3 p = shape.localGetSupportingVertex(btVector3(x, y, z));
        if (std::none_of(out.begin(), out.end(),
                         [&](const btVector3& q) { return p.distance(q) < kSame; }))
          out.push_back(p);
      }
  return out;
}

/// Calls `visit` with each convex shape of an object and its pose in the object.
template <class Visit>
void for_convex_parts(const btCollisionObject& object, const Visit& visit) {
  const auto* compound = static_cast<const btCompoundShape*>(object.getCollisionShape());
  for (int i = 0; i < compound->getNumChildShapes(); ++i)
    if (compound->getChildShape(i)->isConvex())
      visit(*static_cast<const btConvexShape*>(compound->getChildShape(i)),
            compound->getChildTransform(i));
}

/// First hit of a shape that is cast.
struct ShapeHit final : btCollisionWorld::ConvexResultCallback {
  btScalar addSingleResult(btCollisionWorld::LocalConvexResult& hit, bool in_world) override {
    m_closestHitFraction = hit.m_hitFraction;
    normal = in_world ? hit.m_hitNormalLocal : target.getBasis() * hit.m_hitNormalLocal;
    point = hit.m_hitPointLocal;
    return hit.m_hitFraction;
  }
  bool needsCollision(btBroadphaseProxy*) const override { return true; }
  explicit ShapeHit(const btTransform& pose) : target(pose) {}

  btTransform target;
  btVector3 normal{0, 0, 0}, point{0, 0, 0};
};

/// First hit of a corner that is cast.
struct CornerHit final : btCollisionWorld::RayResultCallback {
  btScalar addSingleResult(btCollisionWorld::LocalRayResult& hit, bool in_world) override {
    m_closestHitFraction = hit.m_hitFraction;
    m_collisionObject = hit.m_collisionObject;
    normal = in_world ? hit.m_hitNormalLocal : target.getBasis() * hit.m_hitNormalLocal;
    return hit.m_hitFraction;
  }
  bool needsCollision(btBroadphaseProxy*) const override { return true; }
  explicit CornerHit(const btTransform& pose) : target(pose) {}

  btTransform target;
  btVector3 normal{0, 0, 0};
};

}  // namespace

void SweptContacts::stretch_boxes(btCollisionWorld& world, double dt) {
  fast_.clear();
  const btCollisionObjectArray& objects = world.getCollisionObjectArray();
  for (int i = 0; i < objects.size(); ++i) {
    const btCollisionObject& object = *objects[i];
    const Velocity velocity = velocity_of(object);
    const double travel = travel_of(object, velocity, dt);
    const double threshold = object.getCcdMotionThreshold();
    if (travel > 0 && threshold < kThin) fast_.insert(&object);
    // Most bodies end here.
    if (!(travel > threshold)) continue;
    fast_.insert(&object);
    const Motion motion = motion_of(object, velocity, dt);
    btVector3 low, high, low_end, high_end;
    object.getCollisionShape()->getAabb(motion.from, low, high);
    object.getCollisionShape()->getAabb(motion.to, low_end, high_end);
    low.setMin(low_end);
    high.setMax(high_end);
    const btVector3 margin(kMargin, kMargin, kMargin);
    world.getBroadphase()->setAabb(objects[i]->getBroadphaseHandle(), low - margin, high + margin,
                                   world.getDispatcher());
  }
}

void SweptContacts::add(btCollisionWorld& world, btCollisionDispatcher& dispatcher,
                        btCollisionObject& ground, const GroundShape& shape,
                        const terramechanics::GroundQuery& heights, double dt) {
  if (fast_.empty()) return;
  const auto is_fast = [&](const btCollisionObject* object) { return fast_.count(object) > 0; };
  const btBroadphasePairArray& pairs = world.getPairCache()->getOverlappingPairArray();
  for (int i = 0; i < pairs.size(); ++i) {
    auto* one = static_cast<btCollisionObject*>(pairs[i].m_pProxy0->m_clientObject);
    auto* other = static_cast<btCollisionObject*>(pairs[i].m_pProxy1->m_clientObject);
    if (!is_fast(one) && !is_fast(other)) continue;
    // Pairs of the broad phase include links of one machine, which do not collide.
    if (!dispatcher.needsCollision(one, other)) continue;
    if (one == &ground || other == &ground) {
      cast_down(dispatcher, one == &ground ? *other : *one, ground, shape, heights, dt);
      continue;
    }
    cast(dispatcher, *one, *other, true, dt);
    cast(dispatcher, *other, *one, false, dt);
  }
}

void SweptContacts::contact(btCollisionDispatcher& dispatcher, const btCollisionObject& body_0,
                            const btCollisionObject& body_1, const btVector3& p_0,
                            const btVector3& p_1, const btVector3& normal) {
  btManifoldPoint point(body_0.getWorldTransform().invXform(p_0),
                        body_1.getWorldTransform().invXform(p_1), normal, (p_0 - p_1).dot(normal));
  point.m_positionWorldOnA = p_0;
  point.m_positionWorldOnB = p_1;
  point.m_combinedFriction = btManifoldResult::calculateCombinedFriction(&body_0, &body_1);
  point.m_partId0 = kSweptContact;
  manifolds_.push_back(dispatcher.getNewManifold(&body_0, &body_1));
  manifolds_.back()->addManifoldPoint(point, true);
}

// The target stands still in its own frame, so the mover gets the relative motion.
void SweptContacts::cast(btCollisionDispatcher& dispatcher, btCollisionObject& mover,
                         btCollisionObject& target, bool whole, double dt) {
  const Motion a = motion_of(mover, dt), b = motion_of(target, dt);
  const btTransform to = b.from * b.to.inverse() * a.to;
  const auto hit = [&](const btVector3& start, const btVector3& end, btVector3 normal) {
    if (!(normal.length2() > 0.5)) return;
    normal.normalize();
    if (normal.dot(end - start) > 0) normal = -normal;
    contact(dispatcher, mover, target, start, end, normal);
  };
  for_convex_parts(mover, [&](const btConvexShape& part, const btTransform& place) {
    if (whole) {
      ShapeHit found(b.from);
      btCollisionWorld::objectQuerySingle(&part, a.from * place, to * place, &target,
                                          target.getCollisionShape(), b.from, found, 0);
      if (found.hasHit() && found.m_closestHitFraction > 0) {
        // Where the mover's point of contact is at the start of the step.
        btTransform then;
        btVector3 v, w;
        btTransformUtil::calculateVelocity(a.from, to, 1, v, w);
        btTransformUtil::integrateTransform(a.from, v, w, found.m_closestHitFraction, then);
        hit(a.from * then.invXform(found.point), found.point, found.normal);
      }
    }
    for (const btVector3& corner : corners_of(part)) {
      const btVector3 start = a.from * (place * corner), end = to * (place * corner);
      CornerHit found(b.from);
      btTransform ray_from, ray_to;
      ray_from.setIdentity();
      ray_to.setIdentity();
      ray_from.setOrigin(start);
      ray_to.setOrigin(end);
      btCollisionWorld::rayTestSingle(ray_from, ray_to, &target, target.getCollisionShape(), b.from,
                                      found);
      if (found.m_closestHitFraction < 1)
        hit(start, start.lerp(end, found.m_closestHitFraction), found.normal);
    }
  });
}

void SweptContacts::cast_down(btCollisionDispatcher& dispatcher, btCollisionObject& mover,
                              btCollisionObject& ground, const GroundShape& shape,
                              const terramechanics::GroundQuery& heights, double dt) {
  const Motion motion = motion_of(mover, dt);
  const double deepest = 2 * std::min(kThin, static_cast<double>(mover.getCcdMotionThreshold()));
  const auto above = [&](const btVector3& p) { return p.z() - heights.height(p.x(), p.y()); };
  for_convex_parts(mover, [&](const btConvexShape& part, const btTransform& place) {
    for (const btVector3& corner : corners_of(part)) {
      const btVector3 start = motion.from * (place * corner), end = motion.to * (place * corner);
      // A corner that is deeper is not on its way in.
      if (!(above(end) < 0) || !(above(start) > -deepest)) continue;
      double low = 0, high = 1;
      for (int i = 0; i < kHalvings; ++i) {
        const double middle = 0.5 * (low + high);
        (above(start.lerp(end, middle)) > 0 ? low : high) = middle;
      }
      btVector3 p = start.lerp(end, low);
      if (above(start) < 0) p.setZ(start.z() - above(start));
      contact(dispatcher, mover, ground, start, p,
              to_bt(shape.outward(to_eigen(p), Vec3::UnitZ())));
    }
  });
}

void SweptContacts::drop(btCollisionDispatcher& dispatcher) {
  for (auto one = manifolds_.rbegin(); one != manifolds_.rend(); ++one)
    dispatcher.releaseManifold(*one);
  manifolds_.clear();
}

}  // namespace navvy::vehicle
