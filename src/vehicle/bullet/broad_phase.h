// SPDX-License-Identifier: Apache-2.0
// Which pairs of bodies are near each other.
#pragma once

#include <BulletCollision/BroadphaseCollision/btSimpleBroadphase.h>

#include <utility>
#include <vector>

namespace navvy::vehicle {

/// Bullet's plain list of boxes, searched by one sweep along x instead of pair by pair.
///
/// The pairs come in the order in which the plain list finds them, by the bodies' numbers and
/// nothing else: a tree's order would depend on where bodies have been, and with it the solver's
/// result, so that a loaded snapshot would step on otherwise. Two of which neither is active
/// (Bullet's word) are no pair. Costs n log n and the pairs that overlap along x.
class SweepBroadphase final : public btSimpleBroadphase {
 public:
  explicit SweepBroadphase(int most) : btSimpleBroadphase(most) {}
  void calculateOverlappingPairs(btDispatcher* dispatcher) override;

 private:
  bool is_active(int handle) const;

  std::vector<int> order_, active_;
  std::vector<std::pair<int, int>> pairs_;
};

}  // namespace navvy::vehicle
