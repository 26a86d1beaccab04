// SPDX-License-Identifier: Apache-2.0
// The sums that a trench is judged by: ground at the end against ground at the start.
#pragma once

#include <vector>

#include "control/activities/dig/dig.h"
#include "heightfield/layered_ground.h"
#include "scene/scene.h"
#include "sim/world.h"

namespace navvy::validation {

/// The dig step of the only machine.
control::Dig dig_step(const scene::Scene& world);

/// Terrain end minus start inside and outside the design.
struct TrenchMeasure {
  double inside_volume = 0;  ///< removed within the design's outline [m3]
  double design_volume = 0;  ///< outline x depth [m3]
  /// Removed below the design floor or beside the outline by the bucket [m3].
  double overdug = 0;
  double floor_share = 0;  ///< share of the length whose floor is within 0.10 m of the design
  /// Largest over the length of |centre of removed area - design line| [m].
  double center_offset = 0;
};

TrenchMeasure measure(const heightfield::Ground& ground, const control::Dig& dig);

/// Columns that a machine's tyres passed over, and those one cell beside them.
class WheelTracks {
 public:
  explicit WheelTracks(const heightfield::Ground& ground);
  /// Marks what the wheels of the world's first machine stand on now.
  void mark(const sim::World& world);
  bool hold(int ix, int iy) const;

 private:
  const heightfield::Ground& ground_;
  std::vector<char> marked_;
};

/// Radius [m] around the dump point that belongs to the spoil: foot of a cone of `loose_volume`
/// [m3] at the angle `repose` [rad], and half the cut's width, over which the bucket empties.
double spoil_radius(double loose_volume, double repose, double width);

/// Slopes of the spoil [deg], least first: steepest fall over 0.6 m in eight directions from each
/// column within `spoil_radius` [m] of the dump that has risen by 0.35 m at least; lower ones would
/// see the ground beside the heap.
std::vector<double> heap_slopes(const heightfield::Ground& ground, const control::Dig& dig,
                                double spoil_radius);

/// Largest |change of height| [m] away from the trench (and half a metre around it), the spoil and
/// the tracks.
double change_elsewhere(const heightfield::Ground& ground, const control::Dig& dig,
                        double spoil_radius, const WheelTracks& tracks);

}  // namespace navvy::validation
