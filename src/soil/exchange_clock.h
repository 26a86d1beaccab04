// SPDX-License-Identifier: Apache-2.0
// Decides when the exchange between columns and particles is checked next.
#pragma once

#include <cmath>
#include <cstdint>

#include "core/archive.h"

namespace navvy::soil {

/// Time and tool travel since the last check of the exchange.
///
/// A check is due before the fastest tool has gone a third of a cell, and after some steps when no
/// tool moves. Checks wait for the end of a transfer.
///
/// Rules of the exchange are written in simulated time, so a check that comes a little earlier or
/// later changes little; one that comes too late lets a tool run into ground that is still columns.
class ExchangeClock {
 public:
  /// Largest number of steps between two checks.
  static constexpr std::uint32_t kSteps = 25;

  /// Returns true when the next chance, `ahead` [m] of tool travel later, would be too late.
  bool due(double ahead, double cell) const {
    return first_ || steps_ >= kSteps || travel_ + ahead > kTravel * cell;
  }
  /// Returns the time since the last check [s].
  double elapsed() const { return elapsed_; }
  /// Counts a step of dt [s] in which the fastest tool moves at `tool_speed` [m/s].
  void advance(double dt, double tool_speed) {
    elapsed_ += dt;
    travel_ += tool_speed * dt;
    ++steps_;
  }
  /// Starts anew after a check.
  void restart() {
    first_ = false;
    elapsed_ = travel_ = 0;
    steps_ = 0;
  }
  /// Makes the next check due at once.
  void hurry() { first_ = true; }

  /// Visits all of it: equal clocks check at the same time.
  void visit(Archive& a) {
    a("since_check", elapsed_);
    a("travel", travel_);
    for (const double value : {elapsed_, travel_})
      a.require(std::isfinite(value) && value >= 0, "travel", "must be finite and not negative");
    a("steps_since_check", steps_);
    a("first_check", first_);
  }

 private:
  /// Tool travel between two checks [cells].
  static constexpr double kTravel = 0.3;

  /// Time [s].
  double elapsed_ = 0;
  /// Distance of the fastest tool [m].
  double travel_ = 0;
  std::uint32_t steps_ = 0;
  bool first_ = true;
};

}  // namespace navvy::soil
