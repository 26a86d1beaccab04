// SPDX-License-Identifier: Apache-2.0
// Ruts of crawlers: columns under a belt are pressed to the sinkage of their soil.
#pragma once

#include <vector>

#include "coupling/pushed_soil.h"
#include "coupling/ruts.h"
#include "heightfield/layered_ground.h"
#include "terramechanics/track.h"

namespace navvy::coupling {

constexpr double kSinkSpeed = 0.2;  ///< of a belt into soil that gives way, at most [m/s]

/// Presses what belts stand on, each segment as a plate of the belt's width under p = N / (b l)
/// (plate.h): standing still, or another segment under the same load, adds nothing. What the ground
/// cannot bear flows aside.
///
/// As Ruts does for tyres, and with the same memory: what a tyre has pressed has borne its pressure
/// when a belt comes, and the other way round.
class TrackRuts {
 public:
  /// The ground, and the ruts of tyres on it, which keep the memory, must outlive it.
  TrackRuts(heightfield::Ground& ground, Ruts& ruts)
      : ground_(ground), ruts_(ruts), pushed_(ground) {}

  /// Presses all patches of the world. No column sinks by more than `most` [m] at a time. Columns
  /// under belts are held until the next call, those of tyres besides unless the belts are `alone`.
  void press(const std::vector<terramechanics::TrackPatch>& patches, double most, bool alone);

 private:
  /// One column under `pressure` [Pa] of a plate as wide as the belt, by its own soil.
  void press_column(const PushedSoil::Place& place, double pressure, double most);

  heightfield::Ground& ground_;
  Ruts& ruts_;
  PushedSoil pushed_;  // empty between two calls
};

}  // namespace navvy::coupling
