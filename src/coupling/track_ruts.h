// SPDX-License-Identifier: Apache-2.0
// Ruts of tracked machines: the ground columns under a track are pressed down by the sinkage of
// their soil.
#pragma once

#include <vector>

#include "coupling/pushed_soil.h"
#include "coupling/ruts.h"
#include "heightfield/layered_ground.h"
#include "terramechanics/track.h"

namespace navvy::coupling {

/// Maximum speed at which a track sinks into soil [m/s].
constexpr double kSinkSpeed = 0.2;

/// Presses the ground under tracks. Each segment of a track acts as a plate of the track's width
/// with the pressure load / (length * width) (plate.h). A load that stands still, or another
/// segment with the same load, does not press deeper. Soil that is loaded beyond its bearing
/// capacity flows aside.
///
/// The load history is shared with Ruts: ground that a tyre has pressed remains pressed when a
/// track arrives, and vice versa. The depth of a track does not add to that of earlier passes
/// (RutMemory::leave); tyres that come later add theirs.
class TrackRuts {
 public:
  /// Makes an object that presses `ground`. The load history is stored in `ruts`. Both must outlive
  /// this object.
  TrackRuts(heightfield::Ground& ground, Ruts& ruts)
      : ground_(ground), ruts_(ruts), pushed_(ground) {}

  /// Presses the ground under all segments (`patches`) of all tracks of the world. No column sinks
  /// by more than `most` [m] in a call. The columns under the tracks are held until the next call.
  /// If `alone` is true (there are no tyres), all other columns are released; otherwise the columns
  /// under tyres remain held.
  void press(const std::vector<terramechanics::TrackPatch>& patches, double most, bool alone);

 private:
  // Presses one column with `pressure` [Pa], by the law of its own soil. It sinks by `most` [m] at
  // most.
  void press_column(const PushedSoil::Place& place, double pressure, double most);

  // Ground that is pressed.
  heightfield::Ground& ground_;
  // Stores the load history.
  Ruts& ruts_;
  // Soil displaced during a call of `press`; empty between two calls.
  PushedSoil pushed_;
};

}  // namespace navvy::coupling
