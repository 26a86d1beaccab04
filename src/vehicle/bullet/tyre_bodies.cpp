// SPDX-License-Identifier: Apache-2.0
#include "vehicle/bullet/tyre_bodies.h"

#include <BulletCollision/CollisionShapes/btCylinderShape.h>

#include <algorithm>
#include <cmath>

#include "core/limits.h"
#include "terramechanics/tyre_track.h"
#include "vehicle/bullet/convert.h"

namespace navvy::vehicle {
namespace {

/// Gathers what one disc meets of one body: the places weighed by their depth squared, so that the deepest leads and
/// the normal turns without jumps as the wheel rolls over an edge.
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

bool meets_nobody(const TyreBodies::Machines& machines, const std::vector<Mover>& movers) {
  return machines.size() + movers.size() < 2;
}

/// How much a body gives way to an impulse of 1 along `n` at `p` [1/kg].
double inverse_mass(const TreeBody& tree, int link, const Vec3& n, const Vec3& p) {
  if (tree.fixed_base() && link == 0) return 0;
  Vec6 work;
  work << (p - tree.link(link).X_WL.translation()).cross(n), n;
  return std::max(0.0, work.dot(tree.inverse_mass(link) * work));
}

}  // namespace

void TyreBodies::gather(const Machines& machines, const std::vector<Mover>& movers) {
  bodies_.clear();
  for (const auto& machine : machines) gather(*machine);
  for (const Mover& mover : movers)
    for (const auto& body : mover.bodies()) gather(*body);
}

void TyreBodies::gather(BulletMachine& machine) {
  for (std::size_t l = 0; l < machine.colliders().size(); ++l) {
    Body body;
    body.collider = machine.colliders()[l].get();
    if (body.collider == nullptr) continue;
    body.machine = &machine;
    body.link = static_cast<int>(l);
    body.collider->getCollisionShape()->getAabb(body.collider->getWorldTransform(), body.low, body.high);
    bodies_.push_back(body);
  }
}

TyreBodies::Disc& TyreBodies::disc(std::size_t machine, std::size_t wheel, const scene::Wheel& about) {
  if (discs_.size() <= machine) discs_.resize(machine + 1);
  if (discs_[machine].size() <= wheel) discs_[machine].resize(wheel + 1);
  Disc& out = discs_[machine][wheel];
  if (out.shape) return out;
  // A flat disc swept by a ball: as wide as the track and as large as the tyre.
  const double half = std::min(about.twin_spacing > 0 ? 0.5 * about.width : 0.25 * about.width, 0.45 * about.radius);
  out.shape = std::make_unique<btCylinderShape>(btVector3(about.radius, half, about.radius));
  out.shape->setMargin(half);
  out.object = std::make_unique<btCollisionObject>();
  out.object->setCollisionShape(out.shape.get());
  return out;
}

void TyreBodies::touch(const BulletMachine& own, Disc& disc, const Pose& X_WTrack, const scene::Wheel& about,
                       btCollisionWorld& world) {
  touches_.clear();
  disc.object->setWorldTransform(to_bt(X_WTrack));
  btVector3 low, high;
  disc.shape->getAabb(disc.object->getWorldTransform(), low, high);
  for (const Body& body : bodies_) {
    if (body.machine == &own || !TestAabbAgainstAabb2(low, high, body.low, body.high)) continue;
    Meeting meeting(X_WTrack.translation());
    meeting.disc = disc.object.get();
    world.contactPairTest(disc.object.get(), body.collider, meeting);
    if (!(meeting.sum > 0) || meeting.normal.norm() < 1e-12) continue;
    Touch touch;
    touch.body = &body;
    touch.at.normal = meeting.normal.normalized();
    touch.at.p_W = meeting.place / meeting.sum;
    touch.at.depth = meeting.depth;
    const LinkState link = body.machine->tree().link(body.link);
    touch.at.v_W = link.v_WL + link.w_WL.cross(touch.at.p_W - link.X_WL.translation());
    touch.at.friction = about.friction;
    touch.at.inverse_mass = inverse_mass(body.machine->tree(), body.link, touch.at.normal, touch.at.p_W);
    touches_.push_back(touch);
  }
}

void TyreBodies::push_track(BulletMachine& own, std::size_t wheel, std::size_t track, double dt) {
  MachineWheel& at = own.wheels()[wheel];
  if (touches_.empty()) {
    at.body_bristle[track].setZero();
    return;
  }
  const terramechanics::TyreMotion motion = own.wheels().motion(at);
  const auto deepest = std::max_element(touches_.begin(), touches_.end(),
                                        [](const Touch& a, const Touch& b) { return a.at.depth < b.at.depth; });
  for (auto one = touches_.begin(); one != touches_.end(); ++one) {
    Vec2* bristle = one == deepest ? &at.body_bristle[track] : nullptr;
    const Vec3 f = terramechanics::tyre_body_force(own.wheels().about(wheel), motion, one->at, dt, bristle);
    // To both, at one place: nothing is lost between them.
    own.tree().add_force(at.wheel_link, f, Vec3::Zero(), one->at.p_W);
    one->body->machine->disturb();
    one->body->machine->tree().add_force(one->body->link, -f, Vec3::Zero(), one->at.p_W);
    at.body_W += f;
  }
}

void TyreBodies::push(Machines& machines, const std::vector<Mover>& movers, btCollisionWorld& world, double dt) {
  if (meets_nobody(machines, movers)) return;
  gather(machines, movers);
  for (std::size_t m = 0; m < machines.size(); ++m)
    for (std::size_t w = 0; w < machines[m]->wheels().size(); ++w) {
      MachineWheels& wheels = machines[m]->wheels();
      wheels[w].body_W.setZero();
      // What a crawler's belt runs into its carrier's own shapes meet.
      if (wheels.about(w).track) continue;
      const Pose X_WWheel = wheels.motion(wheels[w]).X_WWheel;
      const double offset = terramechanics::track_offset(wheels.about(w));
      for (std::size_t track = 0; track < 2; ++track) {
        Pose X = X_WWheel;
        X.translation() += (track == 0 ? offset : -offset) * X.linear().col(1);
        touch(*machines[m], disc(m, w, wheels.about(w)), X, wheels.about(w), world);
        push_track(*machines[m], w, track, dt);
      }
    }
}

void TyreBodies::visit(Archive& a, Machines& machines, const std::vector<Mover>& movers) {
  if (meets_nobody(machines, movers)) return;
  for (std::size_t m = 0; m < machines.size(); ++m)
    for (std::size_t w = 0; w < machines[m]->wheels().size(); ++w)
      a.item(m * limits::kLinks + w, [&] {
        a("body_bristle", machines[m]->wheels()[w].body_bristle);
        a("body_W", machines[m]->wheels()[w].body_W);
      });
}

}  // namespace navvy::vehicle
