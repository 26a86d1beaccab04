// SPDX-License-Identifier: Apache-2.0
// Slumping: over-steep resting columns slide without becoming particles, by exact exchange of soil
// between neighbouring columns.
#pragma once

#include <map>
#include <set>
#include <span>
#include <vector>

#include "soil/exchange/slump_scan.h"

namespace navvy::soil {

/// The columns that are sliding, and the sweeps that move their soil.
///
/// A column that failed sheds soil until it is as low as the column that it was too high above. The
/// soil that it sheds comes to lie loose and remoulded on the neighbouring columns, which may then
/// slide as well. In each sweep, pairs of neighbours exchange soil in integer masses. Pairs are
/// processed in four groups (colours) that do not share a column, until no sliding pair is steeper
/// than the friction angle minus 1 degree [docs/exchange.md, slump]. The number of sweeps follows
/// simulated time, so that nothing jumps. Cost is linear in the number of sliding columns.
///
/// Call `fail` once for each result of SlumpScan, then `run` at every check. Soil never moves below
/// the height of the low column at the time of failure, so a cut in bonded soil keeps its foot.
class Slump {
 public:
  /// Starts without sliding columns. `ground`, whose soil is moved, and `table` must outlive this
  /// object.
  Slump(heightfield::Ground& ground, const SlumpTable& table) : ground_(ground), table_(table) {}

  /// Makes the high column of `found`, and those between it and the low column, slide with the next
  /// `run`. A column that is already sliding continues, down to the lower of its two target
  /// heights.
  void fail(const OverSteep& found);
  /// Runs the sweeps that are due after `elapsed` seconds. `blocked(ix, iy)` returns true for a
  /// column that may neither lose nor receive soil in this check; its soil starts to slide when the
  /// column is no longer blocked. Returns the number of columns that changed.
  template <class Blocked>
  int run(double elapsed, const Blocked& blocked);

  /// Returns true if no column is sliding; `run` then costs nothing.
  bool idle() const { return sliding_.empty(); }

  /// Visits the sliding columns in their order. The caller must have opened the archive section.
  /// @throws InputError for columns outside the site.
  void visit(Archive& a);

 private:
  /// State of a sliding column. It ends after a few sweeps in which the column does not move.
  struct Sliding {
    /// Soil of the column above this height in W slides [m].
    double base = 0;
    /// Number of sweeps since the column last moved.
    std::int32_t still = 0;
    /// Visits both members.
    void visit(Archive& a);
  };
  /// Returns the number of whole sweeps that are due after `elapsed` seconds. The fraction of a
  /// sweep is carried over to the next call, unless nothing is sliding.
  int due(double elapsed);
  /// Moves soil from the higher to the lower of two neighbouring columns, if the higher one is
  /// sliding and the drop is too steep. Returns true if soil was moved.
  bool exchange(const PlanKey& a, const PlanKey& b);
  /// Removes columns that have not moved for some sweeps.
  void forget_still();

  /// Columns of the site.
  heightfield::Ground& ground_;
  /// Heights at which soil starts and stops sliding.
  const SlumpTable& table_;
  /// Sliding columns, keyed by (y, x). The map is ordered so that hash and snapshot do not depend
  /// on when columns failed.
  std::map<PlanKey, Sliding> sliding_;
  /// Fraction of a sweep that is carried over to the next check.
  double debt_ = 0;
  /// Scratch memory: layers being moved.
  std::vector<heightfield::SoilLayer> taken_;
};

// The columns of a pair belong to no other pair of the same colour, so the result of a sweep does
// not depend on the order within a colour; the order of the colours is fixed. A column that starts
// to slide during a sweep takes part from the next sweep on, because `keys` holds the columns that
// slide at the start.
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
