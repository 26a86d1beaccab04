// SPDX-License-Identifier: Apache-2.0
// Sleeping of loose bodies that are at rest, so that a step costs almost nothing for them.
#pragma once

#include <LinearMath/btVector3.h>

#include <cstdint>
#include <vector>

#include "core/archive.h"
#include "core/math.h"
#include "terramechanics/ground_query.h"

namespace navvy::vehicle {

/// Sleep state of one loose body: a machine of a single link without joints.
///
/// The body falls asleep when it has moved less than 1 mm and turned less than 2 mrad within half a
/// second. It then keeps its pose at zero velocity. (Velocity is not a useful criterion: contacts
/// are detected anew in every step, so a body at rest trembles.)
///
/// The body wakes when a force acts on it, when the box of a moving body overlaps its own box, and
/// when the ground under it has changed. To detect the latter, each step compares 1/32 of the grid
/// nodes under the body. All of this is saved state, so a loaded body continues to sleep like the
/// saved one.
class Rest {
 public:
  /// Returns true if the body sleeps.
  bool asleep() const { return asleep_; }
  /// Wakes the body because a force or impulse acts on it, and restarts its rest time.
  void disturb() { asleep_ = false, still_ = 0; }
  /// Returns how long the body has been at rest [s], at most the time after which it falls asleep.
  double still() const;
  /// Wakes the body because another body has come near that has been at rest for `still` [s] (0 for
  /// one that never sleeps). Both fall asleep again together, but this body stays active at least
  /// as long as it needs to start falling if the other one leaves.
  void wake(double still);

  /// Updates the rest time of an active body after a step of `dt` [s] that moved it to the pose
  /// `X_WB`. Returns true if the body falls asleep now.
  bool tire(const Pose& X_WB, double dt);
  /// Records the ground under the body's bounding box with the corners `low` and `high` in the
  /// world frame [m], when it falls asleep.
  void lie_down(const terramechanics::GroundQuery& ground, const btVector3& low,
                const btVector3& high);
  /// Wakes the sleeping body before a step if the ground under its bounding box (corners `low` and
  /// `high` in the world frame [m]) differs from the recorded ground. Each call compares another
  /// part of the ground.
  void feel(const terramechanics::GroundQuery& ground, const btVector3& low, const btVector3& high);

  /// Saves, loads or hashes sleep state, rest time and recorded ground.
  void visit(Archive& a);

 private:
  /// Number of parts into which the ground nodes under the body are divided, one of which is
  /// compared per step.
  static constexpr std::uint32_t kParts = 32;

  /// True while the body sleeps.
  bool asleep_ = false;
  /// Time for which the body has stayed near `near_` [s].
  double still_ = 0;
  /// Pose at which the current rest time started.
  Pose near_ = Pose::Identity();
  /// Index of the part of the ground that was compared last.
  std::uint32_t part_ = 0;
  /// Hash of the ground heights in each part, recorded when the body fell asleep.
  std::vector<std::uint64_t> ground_ = std::vector<std::uint64_t>(kParts);
};

}  // namespace navvy::vehicle
