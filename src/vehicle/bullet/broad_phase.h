// SPDX-License-Identifier: Apache-2.0
// Broad phase: pairs of bodies whose boxes overlap.
#pragma once

#include <BulletCollision/BroadphaseCollision/btSimpleBroadphase.h>

#include <utility>
#include <vector>

namespace navvy::vehicle {

/// Bullet's plain list of boxes, searched by one sweep along x instead of pair by pair.
///
/// The pairs are sorted as the plain list would find them, by the bodies' numbers alone. The order
/// of a tree would depend on earlier positions, and so would the solver's result: a loaded snapshot
/// would continue differently. Two inactive bodies (Bullet's term) form no pair. Costs n log n plus
/// the pairs that overlap along x.
class SweepBroadphase final : public btSimpleBroadphase {
 public:
  /// Allocates space for at most `most` bodies.
  explicit SweepBroadphase(int most) : btSimpleBroadphase(most) {}
  void calculateOverlappingPairs(btDispatcher* dispatcher) override;

 private:
  /// Returns whether the body of a box is active.
  bool is_active(int handle) const;

  std::vector<int> order_, active_;
  std::vector<std::pair<int, int>> pairs_;
};

}  // namespace navvy::vehicle
