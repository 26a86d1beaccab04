// SPDX-License-Identifier: Apache-2.0
// Measures by which a trench is judged: final ground minus initial ground.
#pragma once

#include <vector>

#include "control/activities/dig/dig.h"
#include "heightfield/layered_ground.h"
#include "scene/scene.h"
#include "sim/world.h"

namespace navvy::validation {

/// Returns the dig step of the only machine.
control::Dig dig_step(const scene::Scene& world);

/// Final minus initial terrain inside and outside the design.
struct TrenchMeasure {
  double inside_volume = 0;  ///< removed within the design's outline [m3]
  double design_volume = 0;  ///< outline x depth [m3]
  /// Removed below the design floor or beside the outline by the bucket [m3].
  double overdug = 0;
  double floor_share = 0;  ///< share of the length whose floor is within 0.10 m of the design
  /// Largest distance along the length between the centre of the removed area and the design line
  /// [m].
  double center_offset = 0;
};

TrenchMeasure measure(const heightfield::Ground& ground, const control::Dig& dig);

/// Columns that a machine's tyres passed over, and those one cell beside them.
class WheelTracks {
 public:
  explicit WheelTracks(const heightfield::Ground& ground);
  /// Marks the columns under the wheels of the world's first machine.
  void mark(const sim::World& world);
  bool hold(int ix, int iy) const;

 private:
  const heightfield::Ground& ground_;
  std::vector<char> marked_;
};

/// Returns the radius [m] around the dump point that belongs to the spoil: foot of a cone of
/// `loose_volume` [m3] at the angle `repose` [rad], plus half the cut's width, over which the
/// bucket empties.
double spoil_radius(double loose_volume, double repose, double width);

/// Returns the slopes of the spoil [deg], least first: steepest fall over 0.6 m in eight directions
/// from each column within `spoil_radius` [m] of the dump that has risen by 0.35 m at least; lower
/// ones would include the ground beside the heap.
std::vector<double> heap_slopes(const heightfield::Ground& ground, const control::Dig& dig,
                                double spoil_radius);

/// Returns the largest |change of height| [m] outside the trench (and half a metre around it), the
/// spoil and the tracks.
double change_elsewhere(const heightfield::Ground& ground, const control::Dig& dig,
                        double spoil_radius, const WheelTracks& tracks);

/// Returns the volume [m3] by which the ground has risen outside the trench (and half a metre
/// around it), the spoil and the tracks: soil lost on the way.
double volume_elsewhere(const heightfield::Ground& ground, const control::Dig& dig,
                        double spoil_radius, const WheelTracks& tracks);

}  // namespace navvy::validation
