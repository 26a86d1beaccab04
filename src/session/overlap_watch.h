// SPDX-License-Identifier: Apache-2.0
// Bodies that sink into each other during a run.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/archive.h"
#include "sim/world.h"

namespace navvy::session {

/// Time for which two links were deeper in each other than a tenth of the smaller one's smallest
/// side. Contacts of a sound simulation are far less deep, or last for moments.
struct BodyOverlap : sim::LinkPair {
  double start = 0, end = 0;  ///< simulated times of the first and the last deep contact [s]
  double depth_peak = 0;      ///< largest depth of one link in the other [m]
  double share_peak = 0;      ///< largest depth / smallest side of the smaller link [-]

  /// Saves or loads all fields.
  void visit(Archive& a);
};

/// Records the overlaps of a run that last 0.2 s or longer. Pairs that no force can part, such as
/// kinematic machines and walls, are excluded: they are collisions. It changes nothing that a run
/// computes.
class OverlapWatch {
 public:
  /// Looks at `contacts`, those of the last step of `world`. Logs a warning when the first overlap
  /// of two machines has lasted 0.2 s.
  void look(const sim::World& world, const std::vector<sim::MachineContact>& contacts);
  /// Returns the overlaps in the order in which they were noted, at most kMost of them.
  const std::vector<BodyOverlap>& overlaps() const { return list_; }
  /// Returns the number of all overlaps.
  std::int64_t count() const { return count_; }

  /// Saves or loads all fields.
  void visit(Archive& a);

  /// Largest number of overlaps that are kept.
  static constexpr std::size_t kMost = 1000;

 private:
  /// Deep contact in progress.
  struct Open {
    BodyOverlap overlap;       ///< what it was so far
    std::int64_t number = -1;  ///< its number among all overlaps; -1: too short so far
    /// Saves or loads all fields.
    void visit(Archive& a);
  };
  /// Adds an overlap to the list and logs it.
  void note(Open& one, const sim::World& world);

  std::vector<Open> open_;
  std::vector<BodyOverlap> list_;
  std::int64_t count_ = 0;
};

}  // namespace navvy::session
