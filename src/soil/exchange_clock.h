// SPDX-License-Identifier: Apache-2.0
// Clock that decides when the exchange between columns and particles is checked next.
#pragma once

#include <cmath>
#include <cstdint>

#include "core/archive.h"

namespace navvy::soil {

/// Measures time, steps and tool travel since the last check of the exchange.
///
/// A check is due before the fastest tool has moved 0.3 cells, and at the latest after kSteps
/// steps. The check itself can only run between two transfers. While all tools are high above the
/// ground, the caller may leave out checks that are due because of their travel only.
///
/// The rules of the exchange are written in simulated time, so a check that comes slightly earlier
/// or later changes little. A check that comes far too late would let a tool enter ground that is
/// still columns.
class ExchangeClock {
 public:
  /// Largest number of steps between two checks.
  static constexpr std::uint32_t kSteps = 25;

  /// Returns true if a check must run now. `ahead`: distance that the fastest tool travels until
  /// the next opportunity for a check [m]; `cell`: edge of a cell [m].
  bool due(double ahead, double cell) const {
    return first_ || steps_ >= kSteps || travel_ + ahead > kTravel * cell;
  }
  /// Returns true if a check that is due is so because of the travel of the tools only.
  bool due_by_travel() const { return !first_ && steps_ < kSteps; }
  /// Returns the simulated time since the last check [s].
  double elapsed() const { return elapsed_; }
  /// Adds a step of dt [s] in which the fastest tool moves at `tool_speed` [m/s].
  void advance(double dt, double tool_speed) {
    elapsed_ += dt;
    travel_ += tool_speed * dt;
    ++steps_;
  }
  /// Resets the clock after a check.
  void restart() {
    first_ = false;
    elapsed_ = travel_ = 0;
    steps_ = 0;
  }
  /// Makes a check due at the next opportunity.
  void hurry() { first_ = true; }

  /// Visits the whole clock, so that a resumed run checks at the same steps.
  void visit(Archive& a) {
    a("since_check", elapsed_);
    a("travel", travel_);
    for (const double value : {elapsed_, travel_})
      a.require(std::isfinite(value) && value >= 0, "travel", "must be finite and not negative");
    a("steps_since_check", steps_);
    a("first_check", first_);
  }

 private:
  /// Longest tool travel between two checks [cells].
  static constexpr double kTravel = 0.3;

  /// Simulated time since the last check [s].
  double elapsed_ = 0;
  /// Distance travelled by the fastest tool since the last check [m].
  double travel_ = 0;
  /// Number of steps since the last check.
  std::uint32_t steps_ = 0;
  /// True when the next check is due at once: before the first check, and after `hurry`.
  bool first_ = true;
};

}  // namespace navvy::soil
