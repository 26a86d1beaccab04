// SPDX-License-Identifier: Apache-2.0
#include "vehicle/bullet/contact_list.h"

#include <algorithm>

#include "vehicle/collision_box.h"

namespace navvy::vehicle {
namespace {

bool is_same(const ContactBody& a, const ContactBody& b) {
  return a.machine == b.machine && a.obstacle == b.obstacle && a.link == b.link;
}

/// Depth in shares of the smaller body that is listed between any two bodies.
constexpr double kDeep = 0.1;

/// Returns the smallest side of the box around the shapes of an object, in its own axes [m].
double smallest_side(const btCollisionObject& object) {
  btVector3 low, high;
  object.getCollisionShape()->getAabb(btTransform::getIdentity(), low, high);
  const btVector3 side = high - low;
  return std::min({side.x(), side.y(), side.z()});
}

/// Returns true for a body of one link that forces move, such as a rock.
bool is_loose(const BulletMachine& machine) {
  return !machine.tree().fixed_base() && machine.scene().joints.empty();
}

/// Collects the depth of the contact of two objects outside the solver.
class DeepestPoint final : public btCollisionWorld::ContactResultCallback {
 public:
  btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper*, int, int,
                           const btCollisionObjectWrapper*, int, int) override {
    touches = touches || point.getDistance() <= 0;
    depth = std::max(depth, -static_cast<double>(point.getDistance()));
    return 0;
  }
  bool needsCollision(btBroadphaseProxy*) const override { return true; }

  bool touches = false;
  double depth = 0;
};

bool boxes_overlap(const btCollisionObject& a, const btCollisionObject& b) {
  btVector3 low_a, high_a, low_b, high_b;
  a.getCollisionShape()->getAabb(a.getWorldTransform(), low_a, high_a);
  b.getCollisionShape()->getAabb(b.getWorldTransform(), low_b, high_b);
  for (int i = 0; i < 3; ++i)
    if (low_a[i] > high_b[i] || low_b[i] > high_a[i]) return false;
  return true;
}

}  // namespace

bool ContactList::find(const btCollisionObject* object, ContactBody& body) const {
  const void* owner = object->getUserPointer();
  if (owner == nullptr) return false;
  for (std::size_t m = 0; m < machines_->size(); ++m)
    if ((*machines_)[m].get() == owner) {
      body = {static_cast<int>(m), false, object->getUserIndex()};
      return true;
    }
  for (std::size_t m = 0; m < movers_->size(); ++m)
    for (std::size_t b = 0; b < (*movers_)[m].bodies().size(); ++b)
      if ((*movers_)[m].bodies()[b].get() == owner) {
        body = {static_cast<int>(m), true, (*movers_)[m].link(b)};
        return true;
      }
  return false;
}

void ContactList::add(const btCollisionObject* one, const btCollisionObject* other, double force,
                      double depth) {
  BodyContact contact;
  if (!find(one, contact.one) || !find(other, contact.other)) return;
  const double size = std::min(smallest_side(*one), smallest_side(*other));
  // A link and its shells are one body.
  for (BodyContact& known : contacts_) {
    // The order of the two bodies in a contact of Bullet is arbitrary.
    const bool as_is = is_same(known.one, contact.one) && is_same(known.other, contact.other);
    const bool swapped = is_same(known.one, contact.other) && is_same(known.other, contact.one);
    if (!as_is && !swapped) continue;
    known.force += force;
    // Depth and size stay those of one pair of shapes: depth / size is what readers judge.
    if (depth * known.size > known.depth * size) {
      known.depth = depth;
      known.size = size;
    }
    return;
  }
  contact.force = force;
  contact.depth = depth;
  contact.size = size;
  contacts_.push_back(contact);
}

const BulletMachine* ContactList::load_on(const BulletMachine& machine) const {
  const auto found = loads_.find(&machine);
  return found == loads_.end() ? nullptr : found->second;
}

void ContactList::note_load(const BulletMachine& one, const BulletMachine& other) {
  const bool heavy = one.tree().total_mass() > other.tree().total_mass();
  const BulletMachine &load = heavy ? one : other, &under = heavy ? other : one;
  const double mass = under.tree().total_mass();
  if (!(mass > 0) || !(load.tree().total_mass() > kMostMassRatio * mass)) return;
  const BulletMachine*& known = loads_[&under];
  if (known == nullptr || load.tree().total_mass() > known->tree().total_mass()) known = &load;
}

void ContactList::collect(btCollisionWorld& world,
                          const std::vector<std::unique_ptr<BulletMachine>>& machines,
                          const std::vector<Mover>& movers, double dt) {
  contacts_.clear();
  machines_ = &machines;
  movers_ = &movers;
  btDispatcher& dispatcher = *world.getDispatcher();
  for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
    const btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(i);
    const auto* one = static_cast<const BulletMachine*>(manifold.getBody0()->getUserPointer());
    const auto* other = static_cast<const BulletMachine*>(manifold.getBody1()->getUserPointer());
    // The ground is no machine.
    if (one == nullptr || other == nullptr || manifold.getNumContacts() == 0) continue;
    double impulse = 0, depth = 0;
    bool touches = false;
    for (int p = 0; p < manifold.getNumContacts(); ++p) {
      const btManifoldPoint& point = manifold.getContactPoint(p);
      impulse += static_cast<double>(point.m_appliedImpulse);
      depth = std::max(depth, -static_cast<double>(point.getDistance()));
      touches = touches || point.getDistance() <= 0 || point.m_appliedImpulse > 0;
    }
    if (impulse > 0) note_load(*one, *other);
    // Heaps of loose bodies have thousands of contacts.
    if (is_loose(*one) && is_loose(*other) &&
        !(depth > kDeep * std::min(smallest_side(*manifold.getBody0()),
                                   smallest_side(*manifold.getBody1()))))
      continue;
    if (touches) add(manifold.getBody0(), manifold.getBody1(), impulse / dt, depth);
  }
  if (!movers.empty()) collect_of_obstacles(world);
}

void ContactList::collect_of_obstacles(btCollisionWorld& world) {
  // The test of the shapes is slow, so boxes that are apart are left out first.
  const auto test = [&](btCollisionObject* a, btCollisionObject* b) {
    if (!boxes_overlap(*a, *b)) return;
    DeepestPoint found;
    world.contactPairTest(a, b, found);
    // Neither body is moved by forces, so no solver has worked out a force between them.
    if (found.touches) add(a, b, 0, found.depth);
  };
  for (std::size_t m = 0; m < movers_->size(); ++m)
    for (const auto& body : (*movers_)[m].bodies())
      for (btMultiBodyLinkCollider* collider : body->all_colliders()) {
        for (const auto& machine : *machines_)
          if (machine->tree().fixed_base())
            for (btMultiBodyLinkCollider* fixed : machine->all_colliders())
              // Link 0 is fixed; the links that move on it meet obstacles in the solver.
              if (machine->link_of(*fixed) == 0) test(collider, fixed);
        for (std::size_t other = m + 1; other < movers_->size(); ++other)
          for (const auto& further : (*movers_)[other].bodies())
            for (btMultiBodyLinkCollider* second : further->all_colliders()) test(collider, second);
      }
}

}  // namespace navvy::vehicle
