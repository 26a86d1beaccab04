// SPDX-License-Identifier: Apache-2.0
// Ruts of crawlers: columns under a belt are pressed to the sinkage of their soil.
#pragma once

#include <vector>

#include "core/archive.h"
#include "coupling/column_table.h"
#include "coupling/pushed_soil.h"
#include "coupling/rut_memory.h"
#include "heightfield/ground.h"
#include "terramechanics/belt.h"

namespace navvy::coupling {

constexpr double kSinkSpeed = 0.2;  ///< of a belt into soil that gives way, at most [m/s]

/// Presses what belts stand on, each segment as a plate of the belt's width under p = N / (b l) (plate.h), and
/// remembers by column what it has borne: standing still, or another segment under the same load, adds nothing. What
/// the ground cannot bear flows aside.
///
/// As Ruts does for tyres, with a memory of its own: where a tyre runs in a belt's rut it presses fresh ground.
class TrackRuts {
 public:
  /// The ground must outlive it.
  explicit TrackRuts(heightfield::Ground& ground)
      : ground_(ground), pushed_(ground), memory_(ground.nx(), ground.ny()) {}

  /// Presses all patches of the world. No column sinks by more than `most` [m] at a time. Columns under belts are held
  /// until the next call, those of tyres besides unless the belts are `alone`.
  void press(const std::vector<terramechanics::BeltPatch>& patches, double most, bool alone);

  void visit(Archive& a);

 private:
  /// One column under `pressure` [Pa] of a plate as wide as the belt, by its own soil.
  void press_column(const PushedSoil::Place& place, double pressure, double most);

  heightfield::Ground& ground_;
  PushedSoil pushed_;  // empty between two calls
  ColumnTable<RutMemory> memory_;
};

}  // namespace navvy::coupling
