// SPDX-License-Identifier: Apache-2.0
// Contacts between machines, for reports.
#pragma once

#include <vector>

namespace navvy::vehicle {

/// One of the two bodies of a contact.
struct ContactBody {
  int machine = 0;        ///< index of the machine in its engine, or of the obstacle
  bool obstacle = false;  ///< true: the machine belongs to another engine (ObstacleCapability)
  int link = 0;           ///< index in scene::Machine::links
};

/// Contact of links of two machines in the last step. Shells count as their links.
struct BodyContact {
  ContactBody one, other;  ///< the two bodies
  /// Normal force, the mean over the step [N]; 0 between bodies that no force moves.
  double force = 0;
  double depth = 0;  ///< largest depth of one body in the other [m]; 0: they only touch
  /// Smallest side of the box around the shapes of the smaller body [m].
  double size = 0;
};

/// Optional capability of an engine to report which machines touch. An engine has it if it derives
/// from this class.
class ContactCapability {
 public:
  /// Returns the contacts of the last step, in an order that equal runs share. Contacts with the
  /// ground and of machines that a closed hitch couples are not among them, and those between two
  /// bodies of one link that forces move only if they are deeper than a tenth of the smaller body.
  virtual const std::vector<BodyContact>& body_contacts() const = 0;

 protected:
  ~ContactCapability() = default;
};

}  // namespace navvy::vehicle
