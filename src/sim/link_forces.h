// SPDX-License-Identifier: Apache-2.0
// Forces that components outside the simulation put on links: wind, ropes, hoists.
#pragma once

#include <vector>

#include "core/archive.h"
#include "core/math.h"
#include "scene/scene.h"

namespace navvy::coupling {
class Coupling;
}

namespace navvy::sim {

/// Forces on the links with <navvy:force_input>. Each is zero until it is set, and then acts in
/// every step until it is set again. Machines without such links have none and pay nothing.
class LinkForces {
 public:
  /// Collects the links with a force input in the order of the scene.
  explicit LinkForces(const scene::Scene& scene);

  /// Returns the number of links with a force input.
  std::size_t size() const { return forces_.size(); }
  /// Returns the number of the force on a link of a machine of the scene; -1 for a link without a
  /// force input.
  int find(int machine, int link) const;
  /// Returns a force in the world frame [N]. `force` is a number from `find`.
  const Vec3& get(int force) const { return forces_.at(static_cast<std::size_t>(force)).f_W; }
  /// Sets a force in the world frame [N].
  void set(int force, const Vec3& f_W) { forces_.at(static_cast<std::size_t>(force)).f_W = f_W; }

  /// Puts all forces that are not zero on their links for the next step.
  void push(coupling::Coupling& coupling) const;

  /// Saves, loads or hashes all forces.
  void visit(Archive& a);

 private:
  /// Force on one link.
  struct Force {
    /// Indices of the machine in the scene and of the link in its machine.
    int machine = 0, link = 0;
    /// Point on which it acts, in the link's frame [m].
    Vec3 p_L = Vec3::Zero();
    /// Force in the world frame [N].
    Vec3 f_W = Vec3::Zero();
    /// Saves, loads or hashes the force.
    void visit(Archive& a);
  };
  std::vector<Force> forces_;
};

}  // namespace navvy::sim
