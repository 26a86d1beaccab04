// SPDX-License-Identifier: Apache-2.0
#include "vehicle/bullet/contact_candidates.h"

#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <LinearMath/btAabbUtil2.h>

#include <algorithm>

#include "vehicle/bullet/convert.h"

namespace navvy::vehicle {
namespace {

/// Averages the contact points of one disc with one body, weighted by their depth squared, so that
/// the deepest dominates and the normal changes continuously as the wheel rolls over an edge.
struct Meeting final : btCollisionWorld::ContactResultCallback {
  explicit Meeting(const Vec3& middle) : center(middle) {}

  btScalar addSingleResult(btManifoldPoint& at, const btCollisionObjectWrapper*, int, int,
                           const btCollisionObjectWrapper* other, int, int) override {
    const double reach = -at.getDistance();
    if (!(reach > 0)) return 0;
    // Bullet may swap the two: the body's point is the one with the disc on its outer side.
    Vec3 out = to_eigen(at.m_normalWorldOnB);
    Vec3 p = to_eigen(at.getPositionWorldOnB());
    if (other->getCollisionObject() == disc) p = to_eigen(at.getPositionWorldOnA());
    if (out.dot(center - p) < 0) out = -out;
    const double weight = reach * reach;
    normal += weight * out;
    place += weight * p;
    sum += weight;
    depth = std::max(depth, reach);
    return 0;
  }

  const btCollisionObject* disc = nullptr;
  Vec3 center;
  Vec3 normal = Vec3::Zero(), place = Vec3::Zero();
  double sum = 0, depth = 0;
};

/// Returns the inverse mass of a body for an impulse along `n` at `p` [1/kg].
double inverse_mass(const TreeBody& tree, int link, const Vec3& n, const Vec3& p) {
  if (tree.fixed_base() && link == 0) return 0;
  Vec6 work;
  // A unit impulse along n at p causes the twist inverse_mass * work. Its component along n at p is
  // the inverse mass.
  work << (p - tree.link(link).X_WL.translation()).cross(n), n;
  return std::max(0.0, work.dot(tree.inverse_mass(link) * work));
}

}  // namespace

void MetBody::push(const Vec3& f_W, const Vec3& p_W) const {
  // A body that sleeps would ignore the force.
  machine->disturb();
  machine->tree().add_force(link, f_W, Vec3::Zero(), p_W);
}

Disc::Disc(double radius, double half)
    : shape(std::make_unique<btCylinderShape>(btVector3(radius, half, radius))),
      object(std::make_unique<btCollisionObject>()) {
  // The margin rounds the rim of the disc, so that it rolls over edges.
  shape->setMargin(half);
  object->setCollisionShape(shape.get());
}

void Disc::place(const Pose& X_W) {
  center = X_W.translation();
  object->setWorldTransform(to_bt(X_W));
  shape->getAabb(object->getWorldTransform(), low, high);
}

void ContactCandidates::gather(const Machines& machines, const std::vector<Mover>& movers) {
  bodies_.clear();
  for (const auto& machine : machines) gather(*machine);
  for (const Mover& mover : movers)
    for (const auto& body : mover.bodies()) gather(*body);
}

void ContactCandidates::gather(BulletMachine& machine) {
  for (std::size_t l = 0; l < machine.colliders().size(); ++l) {
    MetBody body;
    body.collider = machine.colliders()[l].get();
    if (body.collider == nullptr) continue;
    body.machine = &machine;
    body.link = static_cast<int>(l);
    body.collider->getCollisionShape()->getAabb(body.collider->getWorldTransform(), body.low,
                                                body.high);
    bodies_.push_back(body);
  }
}

// Bullet finds the points, the callback averages them.
std::optional<terramechanics::BodyTouch> ContactCandidates::touch(Disc& disc, const MetBody& body,
                                                                  double friction,
                                                                  btCollisionWorld& world) {
  if (!TestAabbAgainstAabb2(disc.low, disc.high, body.low, body.high)) return {};
  Meeting meeting(disc.center);
  meeting.disc = disc.object.get();
  world.contactPairTest(disc.object.get(), body.collider, meeting);
  if (!(meeting.sum > 0) || meeting.normal.norm() < 1e-12) return {};
  terramechanics::BodyTouch at;
  at.normal = meeting.normal.normalized();
  at.p_W = meeting.place / meeting.sum;
  at.depth = meeting.depth;
  const LinkState link = body.machine->tree().link(body.link);
  at.v_W = link.v_WL + link.w_WL.cross(at.p_W - link.X_WL.translation());
  at.friction = friction;
  at.inverse_mass = inverse_mass(body.machine->tree(), body.link, at.normal, at.p_W);
  return at;
}

}  // namespace navvy::vehicle
