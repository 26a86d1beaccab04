// SPDX-License-Identifier: Apache-2.0
// Broad phase of collision detection: finds pairs of bodies whose bounding boxes overlap.
#pragma once

#include <BulletCollision/BroadphaseCollision/btSimpleBroadphase.h>

#include <utility>
#include <vector>

namespace navvy::vehicle {

/// Bullet's simple broad phase with its search over all pairs replaced by one sweep along the x
/// axis.
///
/// The pairs are sorted by the indices of their bodies, which is the order in which the simple
/// broad phase would find them. A tree's order would depend on earlier positions, and so would the
/// solver's result, so a loaded snapshot would continue differently. Two inactive bodies (Bullet's
/// term) form no pair. Costs O(n log n) plus the number of pairs that overlap along x.
class SweepBroadphase final : public btSimpleBroadphase {
 public:
  /// Allocates space for at most `most` bodies.
  explicit SweepBroadphase(int most) : btSimpleBroadphase(most) {}
  /// Adds all pairs of overlapping boxes to Bullet's pair cache, sorted by the bodies' indices.
  /// Bullet calls it once per step.
  void calculateOverlappingPairs(btDispatcher* dispatcher) override;

 private:
  /// Returns true if the body with the index `handle` is active (Bullet's term).
  bool is_active(int handle) const;

  /// Indices of all boxes sorted by their lower x, and of the boxes that overlap the sweep's
  /// current x.
  std::vector<int> order_, active_;
  /// Pairs of overlapping boxes found in the current step, smaller index first.
  std::vector<std::pair<int, int>> pairs_;
};

}  // namespace navvy::vehicle
