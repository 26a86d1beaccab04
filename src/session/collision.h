// SPDX-License-Identifier: Apache-2.0
// Collisions of machines during a run.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/archive.h"
#include "sim/world.h"

namespace navvy::session {

/// One collision of two links: a time in which they touched. Breaks of less than 0.1 s do not end
/// it.
struct MachineCollision : sim::LinkPair {
  double start = 0, end = 0;  ///< simulated times of the first and the last contact [s]
  /// Largest normal force, the mean over a step [N]; 0 if no force moves either machine.
  double force_peak = 0;
  double depth_peak = 0;  ///< largest depth of one link in the other [m]

  /// Saves or loads all fields.
  void visit(Archive& a);
};

/// Returns machine and link as text, such as "'robot' (chassis)". Both are indices, as in
/// sim::LinkPair.
std::string name_of_link(const sim::World& world, int machine, int link);
/// Returns the two machines of a collision with their links, as "'robot' (chassis) touches 'wall'
/// (panel)".
std::string text_of(const sim::LinkPair& links, const sim::World& world);

/// Records the collisions of a run. Bodies of one link that forces move, such as rocks and loads,
/// are excluded: tools touch and carry them. It changes nothing that a run computes.
class CollisionWatch {
 public:
  /// Records `contacts`, those of the last step of `world`. Logs a warning at the first contact of
  /// each pair of machines.
  void look(const sim::World& world, const std::vector<sim::MachineContact>& contacts);
  /// Returns the collisions in the order in which they began, at most kMost of them.
  const std::vector<MachineCollision>& collisions() const { return list_; }
  /// Returns the number of all collisions.
  std::int64_t count() const { return count_; }
  /// Returns the first collision of which look() last saw a contact; empty if nothing touched.
  const std::optional<MachineCollision>& touching() const { return touching_; }

  /// Saves or loads all fields.
  void visit(Archive& a);

  /// Largest number of collisions that are kept.
  static constexpr std::size_t kMost = 1000;

 private:
  std::vector<MachineCollision> list_;
  std::int64_t count_ = 0;
  /// Pairs of machines whose first collision was logged.
  std::set<std::pair<int, int>> logged_;
  /// A collision with a contact in the last step. Not part of the state: each step sets it.
  std::optional<MachineCollision> touching_;
};

}  // namespace navvy::session
