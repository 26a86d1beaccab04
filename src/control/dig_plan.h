// SPDX-License-Identifier: Apache-2.0
// Where the next scoop goes: layer by layer, from the far end to the near one.
#pragma once

#include <vector>

#include "control/arm.h"
#include "heightfield/ground.h"
#include "scene/program.h"

namespace navvy::control {

/// The trench in the swing plane: reach from the swing axis along the line, heights in S.
struct TrenchLine {
  Vec2 near = Vec2::Zero(), far = Vec2::Zero();  ///< ends in W [m]; `far` is farther from the swing axis
  double near_reach = 0, far_reach = 0;          ///< [m]
  double swing = 0;                              ///< angle of the swing joint over the line [rad]
  double offset = 0;                             ///< distance of the line from the swing axis [m]
};

/// One scoop along the line: from `start` to at most `end` reach, the tip at or above `level` of W.
struct Scoop {
  double start = 0, end = 0;  ///< reach [m], start > end
  double level = 0;           ///< depth below the surface at the start of the dig [m]
  bool any = false;           ///< false: nothing left to dig
};

/// Surface along the line before and during the dig.
class DigPlan {
 public:
  DigPlan() = default;
  DigPlan(const scene::Dig& dig, const TrenchLine& line, const heightfield::Ground& ground);

  Scoop next(const heightfield::Ground& ground) const;
  /// Reach at which `bank_volume` [m3] has been cut along the scoop; its end when it never is.
  double fill_end(const heightfield::Ground& ground, const Scoop& scoop, double bank_volume) const;
  /// Depth still to be taken off at `reach` to get to `level` [m].
  double remaining(const heightfield::Ground& ground, double reach, double level) const;
  /// W height of the surface before the dig at `reach` [m].
  double start_height(double reach) const;
  const TrenchLine& line() const { return line_; }
  int samples() const { return static_cast<int>(start_.size()); }

  void save(StateWriter& writer) const;
  void load(StateReader& reader);

 private:
  Vec2 point(double reach) const;
  double height(const heightfield::Ground& ground, double reach) const;

  scene::Dig dig_;
  TrenchLine line_;
  std::vector<double> start_;  // W heights from near to far [m]
};

/// The trench seen from a machine whose frame S of the swing axis is X_WS.
TrenchLine trench_line(const scene::Dig& dig, const Pose& X_WS);

}  // namespace navvy::control
