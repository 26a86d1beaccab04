// SPDX-License-Identifier: Apache-2.0
// Distances that machines drive.
#pragma once

#include <cstdint>
#include <vector>

#include "core/archive.h"
#include "core/math.h"
#include "sim/world.h"

namespace navvy::session {

/// Distance that one machine has driven.
struct Travel {
  /// Last place at which the distance was increased, in plan [m].
  Vec2 place = Vec2::Zero();
  /// Length of the path of the base link's origin in plan, by chords of kTravelChord [m].
  double distance = 0;
  /// 1 once `place` is known.
  std::int64_t known = 0;

  /// Saves or loads all fields.
  void visit(Archive& a);
};

/// Length of the chords that a path is measured by [m]. A machine that rocks on its tyres while it
/// digs moves less and drives no distance.
inline constexpr double kTravelChord = 0.1;

/// Measures the distances that all machines of a world drive. Changes nothing that a run computes.
class TravelLog {
 public:
  /// Prepares for the machines of `world`.
  explicit TravelLog(const sim::World& world);
  /// Takes the present places of the machines. Call it after each step.
  void look(const sim::World& world);
  /// Returns the travel of each machine, in the order of the scene.
  const std::vector<Travel>& machines() const { return machines_; }

  /// Saves or loads the travel of each machine.
  void visit(Archive& a);

 private:
  // Travel of each machine.
  std::vector<Travel> machines_;
};

}  // namespace navvy::session
