// SPDX-License-Identifier: Apache-2.0
// Lists the contacts between machines in the Bullet engine. Only reads.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>

#include <map>
#include <memory>
#include <vector>

#include "vehicle/body_contact.h"
#include "vehicle/bullet/bullet_machine.h"
#include "vehicle/bullet/mover.h"

namespace navvy::vehicle {

/// Contacts of one step, one entry per pair of links.
class ContactList {
 public:
  /// Lists the contacts of the step that was solved last. Call it before contacts are dropped. `dt`
  /// [s] is the length of the step.
  void collect(btCollisionWorld& world, const std::vector<std::unique_ptr<BulletMachine>>& machines,
               const std::vector<Mover>& movers, double dt);
  /// Returns the contacts.
  const std::vector<BodyContact>& contacts() const { return contacts_; }
  /// Returns the heaviest body that has pressed on `machine` since the engine was made and that is
  /// too heavy for contacts (kMostMassRatio); null if there is none. Only for messages.
  const BulletMachine* load_on(const BulletMachine& machine) const;

 private:
  /// Records the heavier of two bodies that press on each other, if it is too heavy.
  void note_load(const BulletMachine& one, const BulletMachine& other);
  /// Adds a contact of two collision objects to the entry of their links, if both are of machines.
  void add(const btCollisionObject* one, const btCollisionObject* other, double force,
           double depth);
  /// Finds the machine or obstacle of a collision object. Returns false for the ground.
  bool find(const btCollisionObject* object, ContactBody& body) const;
  /// Tests obstacles against fixed machines and other obstacles, which the engine does not collide.
  void collect_of_obstacles(btCollisionWorld& world);

  const std::vector<std::unique_ptr<BulletMachine>>* machines_ = nullptr;
  const std::vector<Mover>* movers_ = nullptr;
  std::vector<BodyContact> contacts_;
  /// Heaviest body that has pressed on each machine, if it is too heavy for contacts.
  std::map<const BulletMachine*, const BulletMachine*> loads_;
};

}  // namespace navvy::vehicle
