// SPDX-License-Identifier: Apache-2.0
// Ruts of crawlers: columns under a track are pressed to the sinkage of their soil.
#pragma once

#include <vector>

#include "coupling/pushed_soil.h"
#include "coupling/ruts.h"
#include "heightfield/layered_ground.h"
#include "terramechanics/track.h"

namespace navvy::coupling {

/// Largest speed of a track into yielding soil [m/s].
constexpr double kSinkSpeed = 0.2;

/// Presses the ground under tracks, each segment as a plate of the track's width under p = N / (b
/// l) (plate.h). A load that stands still, or another segment under the same load, adds nothing.
/// Soil beyond the bearing capacity flows aside.
///
/// Shares the load history with Ruts: ground pressed by a tyre keeps its pressure on record when a
/// track arrives, and vice versa.
class TrackRuts {
 public:
  /// Starts without loads. The ground and `ruts`, which store the history, must outlive this
  /// object.
  TrackRuts(heightfield::Ground& ground, Ruts& ruts)
      : ground_(ground), ruts_(ruts), pushed_(ground) {}

  /// Presses all patches of the world. No column sinks by more than `most` [m] per call. Columns
  /// under tracks are held until the next call; columns under tyres stay held unless the tracks are
  /// `alone`.
  void press(const std::vector<terramechanics::TrackPatch>& patches, double most, bool alone);

 private:
  /// Presses one column with `pressure` [Pa] of a plate as wide as the track, by the law of its own
  /// soil.
  void press_column(const PushedSoil::Place& place, double pressure, double most);

  heightfield::Ground& ground_;
  Ruts& ruts_;
  // Empty between two calls.
  PushedSoil pushed_;
};

}  // namespace navvy::coupling
