// SPDX-License-Identifier: Apache-2.0
// Sleeping of loose bodies that are at rest: a step costs nothing for them.
#pragma once

#include <LinearMath/btVector3.h>

#include <cstdint>
#include <vector>

#include "core/archive.h"
#include "core/math.h"
#include "terramechanics/ground_query.h"

namespace navvy::vehicle {

/// Sleep state of one body: a machine of a single link that nothing holds.
///
/// It falls asleep when it has moved less than 1 mm (and 2 mrad) in half a second, and keeps its
/// pose at zero velocity. (Velocity is no criterion: contacts are detected anew in every step, and
/// a body at rest trembles.) It wakes when something pushes it, when a moving box overlaps its box,
/// and when the ground under it has changed: each step compares another 32nd of its nodes. All of
/// this is state: a loaded body sleeps on as the saved one.
class Rest {
 public:
  /// Returns whether the body sleeps.
  bool asleep() const { return asleep_; }
  /// Wakes the body because something pushes it.
  void disturb() { asleep_ = false, still_ = 0; }
  /// Returns how long the body has been at rest, at most the time it takes to fall asleep [s].
  double still() const;
  /// Wakes the body because another one has come near that has been at rest for `still` [s] (0 for
  /// one that never sleeps). It falls asleep again together with the other, but not before it would
  /// begin to fall if the other left.
  void wake(double still);

  /// Updates the rest time after a step that brought the awake body here. Returns true when it
  /// falls asleep now.
  bool tire(const Pose& X_WB, double dt);
  /// Records the ground under its box `low`, `high` [m].
  void lie_down(const terramechanics::GroundQuery& ground, const btVector3& low,
                const btVector3& high);
  /// Wakes the sleeping body before a step if the ground under its box differs from the recorded
  /// one.
  void feel(const terramechanics::GroundQuery& ground, const btVector3& low, const btVector3& high);

  /// Visits the rest time and the recorded ground.
  void visit(Archive& a);

 private:
  static constexpr std::uint32_t kParts = 32;

  bool asleep_ = false;
  double still_ = 0;  // [s] near near_
  Pose near_ = Pose::Identity();
  std::uint32_t part_ = 0;  // part of the ground compared last
  // Hashes of the heights when it fell asleep
  std::vector<std::uint64_t> ground_ = std::vector<std::uint64_t>(kParts);
};

}  // namespace navvy::vehicle
