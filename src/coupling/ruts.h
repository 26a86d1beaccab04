// SPDX-License-Identifier: Apache-2.0
// Wheel ruts: columns under a tyre are pressed to the sinkage of their soil.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <vector>

#include "core/hash.h"
#include "core/state_io.h"
#include "heightfield/ground.h"
#include "scene/machine.h"
#include "vehicle/engine.h"

namespace navvy::coupling {

/// Presses ruts by Bekker's law p = (kc/b + kphi) z^n [Bekker 1969] [Wong 2008, eq. 2.46].
///
/// Each column remembers the largest pressure it has borne since its surface last changed by other means, so standing
/// still or a second pass at the same load adds nothing. Mass is kept: the column's density state rises.
class Ruts {
 public:
  explicit Ruts(heightfield::Ground& ground) : ground_(ground) {}

  /// Presses the contact patch of one wheel that carries `wheel.force_W`; tyres of a twin pair each carry half. No
  /// column sinks by more than `most` [m] at a time: ground that gives way at once lets the wheel fall, and what it
  /// hits with presses deeper than its load would.
  void press(const scene::Wheel& tyre, const vehicle::WheelState& wheel,
             double most = std::numeric_limits<double>::infinity());

  /// Sinkage [m] of a plate of width b [m] under pressure p [Pa].
  static double sinkage(const scene::Soil& soil, double pressure, double width);
  /// The pressure [Pa] that it bears when it has sunk by z [m].
  static double bearing(const scene::Soil& soil, double z, double width);

  void hash(StateHash& hash) const;
  void save(StateWriter& writer) const;
  void load(StateReader& reader);

 private:
  struct Memory {
    double pressure = 0;  ///< largest borne [Pa]
    double height = 0;    ///< surface it left behind [m]
  };
  void press_column(int ix, int iy, double pressure, double width, double most);

  heightfield::Ground& ground_;
  std::map<std::int64_t, Memory> memory_;  ///< by iy * nx + ix, ordered for repeatability
};

}  // namespace navvy::coupling
