// SPDX-License-Identifier: Apache-2.0
// Slumping of over-steep resting columns without particles: exact exchange between neighbours.
#pragma once

#include <map>
#include <set>
#include <span>
#include <vector>

#include "soil/exchange/slump_scan.h"

namespace navvy::soil {

/// Columns that slide, and the sweeps that move them.
///
/// A column that failed slides down to the height of the column it failed over. The soil that it
/// sheds lies loose and remoulded on its neighbours and slides on. Pairs of neighbours exchange
/// soil in four colours, in integers, until no sliding pair is steeper than phi - 1 deg
/// [docs/exchange.md, slump]. Sweeps follow simulated time, so that nothing jumps. Cost is linear
/// in the sliding columns.
///
/// Usage: `fail` once for each finding of SlumpScan, then `run` at every check. Soil never moves
/// below the height at which its column failed, so a cut in bonded soil keeps its foot.
class Slump {
 public:
  /// Moves soil of `ground`; ground and table must outlive it.
  Slump(heightfield::Ground& ground, const SlumpTable& table) : ground_(ground), table_(table) {}

  /// Starts the sliding of the columns from the high to the low one, with the next `run`. Columns
  /// that slide already continue, down to the lower of the two heights.
  void fail(const OverSteep& found);
  /// Runs the sweeps of `elapsed` seconds. `blocked` returns true for a column that must stay as it
  /// is now: it neither gives nor takes soil. Soil above it waits until it is free or at rest.
  /// Returns the number of columns that changed.
  template <class Blocked>
  int run(double elapsed, const Blocked& blocked);

  /// Returns true when nothing slides; `run` then costs nothing.
  bool idle() const { return sliding_.empty(); }

  /// Visits the sliding columns in their order. The owner opens the section.
  /// @throws InputError for columns outside the site.
  void visit(Archive& a);

 private:
  // A column that sheds soil while it is steep. A few sweeps without motion end it.
  struct Sliding {
    /// Soil above this height in W slides [m].
    double base = 0;
    /// Sweeps since it last moved.
    std::int32_t still = 0;
    void visit(Archive& a);
  };
  /// Returns the number of whole sweeps that are due. Carries the remainder over; drops it while
  /// nothing slides.
  int due(double elapsed);
  /// Moves soil from the higher of two neighbours to the lower. Returns false when none had to
  /// move.
  bool exchange(const PlanKey& a, const PlanKey& b);
  /// Drops columns that have not moved for some sweeps.
  void forget_still();

  heightfield::Ground& ground_;
  const SlumpTable& table_;
  // Ordered by column, so that hash and snapshot do not depend on when columns failed.
  std::map<PlanKey, Sliding> sliding_;
  /// Share of a sweep that is carried to the next check.
  double debt_ = 0;
  // Scratch memory.
  std::vector<heightfield::SoilLayer> taken_;
};

// The four colours separate the pairs of one colour, so a sweep does not depend on the order within
// a colour; the order of colours is fixed. A column that starts to slide during a sweep joins the
// next one, as `keys` are those at the start.
template <class Blocked>
int Slump::run(double elapsed, const Blocked& blocked) {
  std::set<PlanKey> changed;
  for (int sweeps = due(elapsed); sweeps > 0 && !idle(); --sweeps) {
    // A copy, as exchange() adds columns while the sweep runs.
    std::vector<PlanKey> keys;
    for (const auto& [key, sliding] : sliding_) keys.push_back(key);
    for (auto& [key, sliding] : sliding_) ++sliding.still;
    // Colours: pairs along x that start on even, then odd columns; then along y.
    for (int colour = 0; colour < 4; ++colour) {
      const int step_x = colour < 2 ? 1 : 0, step_y = 1 - step_x;
      for (const PlanKey& key : keys) {
        const int along = step_x != 0 ? key.second : key.first;
        PlanKey a = key;
        if ((along & 1) != (colour & 1)) {
          a = {key.first - step_y, key.second - step_x};
          // Its own turn moves this pair.
          if (sliding_.count(a) != 0) continue;
        }
        const PlanKey b{a.first + step_y, a.second + step_x};
        if (!ground_.contains(a.second, a.first) || !ground_.contains(b.second, b.first)) continue;
        if (blocked(a.second, a.first) || blocked(b.second, b.first)) continue;
        if (!exchange(a, b)) continue;
        changed.insert(a);
        changed.insert(b);
      }
    }
    forget_still();
  }
  return static_cast<int>(changed.size());
}

}  // namespace navvy::soil
