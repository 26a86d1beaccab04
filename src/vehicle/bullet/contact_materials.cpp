// SPDX-License-Identifier: Apache-2.0
#include "vehicle/bullet/contact_materials.h"

#include <algorithm>
#include <cmath>

#include "vehicle/bullet/convert.h"
#include "vehicle/bullet/swept_contacts.h"

namespace navvy::vehicle {
namespace {

/// Slower bodies are at rest: contacts are detected anew in every step, so a body at rest trembles.
/// tuned: BulletMaterials.*
constexpr double kSliding = 0.05;  // [m/s]
/// Slower impacts do not rebound, or nothing would come to rest: Bullet's own threshold [m/s].
constexpr double kBlow = 0.2;
/// Time in which a compliant contact yields to a load [s]: it creeps and does not oscillate.
constexpr double kYields = 0.05;
/// Gap that no body closes in a step [m].
constexpr double kFar = 1e3;

Vec3 velocity_at(const BulletMachine* machine, int link, const Vec3& p_W) {
  if (machine == nullptr) return Vec3::Zero();
  const LinkState state = machine->tree().link(link);
  return state.v_WL + state.w_WL.cross(p_W - state.X_WL.translation());
}

}  // namespace

// Builds a square table, so that a pair is one look-up.
ContactMaterials::ContactMaterials(scene::Materials table) : table_(std::move(table)) {
  for (const scene::MaterialPair& pair : table_.pairs)
    for (const std::string& name : pair.materials)
      if (index_of(name) < 0) names_.push_back(name);
  for (const std::string& a : names_)
    for (const std::string& b : names_) pairs_.push_back(table_.pair(a, b));
  soft_ = std::any_of(table_.pairs.begin(), table_.pairs.end(),
                      [](const auto& pair) { return pair.softness > 0; });
  ground_ = index_of(table_.ground);
}

int ContactMaterials::index_of(const std::string& material) const {
  const auto found = std::find(names_.begin(), names_.end(), material);
  return found == names_.end() ? -1 : static_cast<int>(found - names_.begin());
}

void ContactMaterials::mark(BulletMachine& machine) const {
  for (const auto& collider : machine.all_colliders()) {
    const int link = machine.link_of(*collider);
    collider->setUserPointer(&machine);
    collider->setUserIndex(link);
    collider->setUserIndex2(
        index_of(machine.scene().links[static_cast<std::size_t>(link)].material.name));
  }
}

bool ContactMaterials::stands(const Side& side) {
  return side.machine == nullptr || (side.link == 0 && side.machine->tree().fixed_base());
}

ContactMaterials::Side ContactMaterials::side(const btCollisionObject& object,
                                              const btCollisionObject& ground) const {
  if (&object == &ground) return {ground_, nullptr, 0};
  return {object.getUserIndex2(), static_cast<const BulletMachine*>(object.getUserPointer()),
          object.getUserIndex()};
}

const scene::MaterialPair* ContactMaterials::pair(const Side& a, const Side& b) const {
  if (a.material < 0 || b.material < 0) return nullptr;
  return pairs_[static_cast<std::size_t>(a.material) * names_.size() +
                static_cast<std::size_t>(b.material)];
}

// Bullet's normal points from body 1 to body 0.
void ContactMaterials::set(const scene::MaterialPair& pair, const Vec3& v, const Vec3& weight,
                           btManifoldPoint& point) const {
  const Vec3 n = to_eigen(point.m_normalWorldOnB);
  const double meets = -v.dot(n), deep = -point.getDistance();
  point.m_combinedFriction =
      (v + meets * n).norm() > kSliding ? pair.kinetic_friction : pair.static_friction;
  if (!(pair.restitution > 0) || meets < kBlow) return;
  // Bullet closes a gap and resolves a penetration within the same row, and both would change the
  // rebound. So the impact acts in the first step that finds the bodies overlapping, by their
  // velocity alone.
  if (deep < 0 && point.m_partId0 != kSweptContact) {
    point.setDistance(kFar);
    return;
  }
  // Bodies that would pass each other in this step find no later overlap.
  if (deep < 0) {
    point.setDistance(0);
    point.m_combinedRestitution = pair.restitution;
    point.m_contactERP = 0;
    point.m_contactCFM = 0;
    point.m_contactPointFlags |= BT_CONTACT_FLAG_HAS_CONTACT_ERP | BT_CONTACT_FLAG_HAS_CONTACT_CFM;
    return;
  }
  // Velocity when the bodies met, and the velocity that returns them there with the restitution's
  // share of it.
  const double fall = 2 * deep * std::max(0.0, -weight.dot(n)),
               met = std::max(0.0, meets * meets - fall);
  point.m_combinedRestitution = std::sqrt(pair.restitution * pair.restitution * met + fall) / meets;
  point.m_contactERP = 0;
  point.m_contactCFM = 0;
  point.m_contactPointFlags |= BT_CONTACT_FLAG_HAS_CONTACT_ERP | BT_CONTACT_FLAG_HAS_CONTACT_CFM;
}

// Visits the points of every manifold whose sides have materials.
void ContactMaterials::apply(btDispatcher& dispatcher, const btCollisionObject& ground,
                             const Vec3& gravity) {
  if (names_.empty()) return;
  for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
    btPersistentManifold* manifold = dispatcher.getManifoldByIndexInternal(i);
    const Side a = side(*manifold->getBody0(), ground), b = side(*manifold->getBody1(), ground);
    const scene::MaterialPair* together = pair(a, b);
    if (together == nullptr) continue;
    // Two free bodies fall alike.
    const Vec3 weight = stands(b) ? gravity : stands(a) ? Vec3(-gravity) : Vec3(Vec3::Zero());
    for (int p = 0; p < manifold->getNumContacts(); ++p) {
      btManifoldPoint& point = manifold->getContactPoint(p);
      const Vec3 p_W = to_eigen(point.getPositionWorldOnB());
      set(*together, velocity_at(a.machine, a.link, p_W) - velocity_at(b.machine, b.link, p_W),
          weight, point);
    }
  }
  if (soft_) soften(dispatcher, ground);
}

/// Makes compliant contacts softer. The table's compliance is that of two bodies together, so every
/// bearing point between them gets its share.
void ContactMaterials::soften(btDispatcher& dispatcher, const btCollisionObject& ground) {
  bearing_.clear();
  const auto for_soft_points = [&](const auto& visit) {
    for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
      btPersistentManifold* manifold = dispatcher.getManifoldByIndexInternal(i);
      const scene::MaterialPair* together =
          pair(side(*manifold->getBody0(), ground), side(*manifold->getBody1(), ground));
      if (together == nullptr || !(together->softness > 0)) continue;
      int& bearing = bearing_[std::minmax(manifold->getBody0(), manifold->getBody1())];
      for (int p = 0; p < manifold->getNumContacts(); ++p)
        if (manifold->getContactPoint(p).getDistance() < 0)
          visit(*together, bearing, manifold->getContactPoint(p));
    }
  };
  for_soft_points([](const scene::MaterialPair&, int& bearing, btManifoldPoint&) { ++bearing; });
  for_soft_points(
      [](const scene::MaterialPair& together, const int& bearing, btManifoldPoint& point) {
        if ((point.m_contactPointFlags & BT_CONTACT_FLAG_HAS_CONTACT_CFM) != 0)
          return;  // an impact
        point.m_combinedContactStiffness1 = 1 / (together.softness * bearing);
        point.m_combinedContactDamping1 = kYields * point.m_combinedContactStiffness1;
        point.m_contactPointFlags |= BT_CONTACT_FLAG_CONTACT_STIFFNESS_DAMPING;
      });
}

}  // namespace navvy::vehicle
