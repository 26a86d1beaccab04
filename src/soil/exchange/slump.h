// SPDX-License-Identifier: Apache-2.0
// Lets over-steep resting columns slide without particles: exact exchange between neighbours.
#pragma once

#include <map>
#include <set>
#include <span>
#include <vector>

#include "soil/exchange/slump_scan.h"

namespace navvy::soil {

/// Columns that slide, and the sweeps that move them.
///
/// A column that failed slides down to the height of what it failed over; what it sheds lies loose
/// and remoulded on its neighbours and slides on. Pairs of neighbours exchange soil in four
/// colours, in integers, until no pair that slides is steeper than phi - 1 deg
/// [docs/exchange.md, slump]. Sweeps follow simulated time, so that nothing jumps. Costs the
/// sliding columns only.
class Slump {
 public:
  /// Both must outlive it.
  Slump(heightfield::Ground& ground, const SlumpTable& table) : ground_(ground), table_(table) {}

  /// Lets the columns from the high to the low one slide. They start at the next `run`. What slides
  /// already goes on, down to the lower of the two heights.
  void fail(const OverSteep& found);
  /// Runs the sweeps of `elapsed` seconds. `blocked` answers for a column whether it must stay as
  /// it is now. Returns the number of columns that changed. Blocked columns neither give nor take,
  /// and wait: the soil of the ones above stays until they are free or at rest.
  template <class Blocked>
  int run(double elapsed, const Blocked& blocked);

  /// True when nothing slides: then `run` costs nothing.
  bool idle() const { return sliding_.empty(); }

  /// What slides and how far, in the order of the columns. The owner opens the section that these
  /// are part of.
  /// @throws InputError for columns outside the site.
  void visit(Archive& a);

 private:
  // A column that gives soil away while it is steep. A few sweeps without motion end it.
  struct Sliding {
    double base = 0;         ///< soil above this W height slides [m]
    std::int32_t still = 0;  ///< sweeps since it last moved
    void visit(Archive& a);
  };
  /// Whole sweeps that are due. Carries the rest of a sweep on; drops it while nothing slides.
  int due(double elapsed);
  /// Soil from the higher of two neighbours to the lower; false when nothing had to move.
  bool exchange(const PlanKey& a, const PlanKey& b);
  void forget_still();

  heightfield::Ground& ground_;
  const SlumpTable& table_;
  // Ordered by column, so that hash and save do not depend on when columns failed.
  std::map<PlanKey, Sliding> sliding_;
  double debt_ = 0;  ///< share of a sweep carried to the next check
  // Scratch, kept for its memory.
  std::vector<heightfield::SoilLayer> taken_;
};

// The four colours keep the pairs of one colour apart, so a sweep does not depend on the order
// within a colour; their own order is fixed. A column that begins to slide during a sweep joins at
// the next one, as `keys` are those at its start.
template <class Blocked>
int Slump::run(double elapsed, const Blocked& blocked) {
  std::set<PlanKey> changed;
  for (int sweeps = due(elapsed); sweeps > 0 && !idle(); --sweeps) {
    // Copied, as exchange() adds columns while the sweep runs.
    std::vector<PlanKey> keys;
    for (const auto& [key, sliding] : sliding_) keys.push_back(key);
    for (auto& [key, sliding] : sliding_) ++sliding.still;
    // Colours: pairs along x that start on even, odd columns, then along y.
    for (int colour = 0; colour < 4; ++colour) {
      const int step_x = colour < 2 ? 1 : 0, step_y = 1 - step_x;
      for (const PlanKey& key : keys) {
        const int along = step_x != 0 ? key.second : key.first;
        PlanKey a = key;
        if ((along & 1) != (colour & 1)) {
          a = {key.first - step_y, key.second - step_x};
          if (sliding_.count(a) != 0) continue;  // that one brings the pair
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
