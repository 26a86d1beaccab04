// SPDX-License-Identifier: Apache-2.0
// Wheel ruts: columns under a tyre are pressed to the sinkage of their soil.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <set>
#include <vector>

#include "core/archive.h"
#include "heightfield/ground.h"
#include "scene/machine.h"
#include "terramechanics/tyre_patch.h"
#include "vehicle/engine.h"

namespace navvy::coupling {

/// One wheel, referred to, and how it stands.
struct LoadedTyre {
  const scene::Wheel& tyre;
  vehicle::WheelState wheel;
};

constexpr int kRutInterval = 8;  ///< steps between presses; a wheel at 2.5 m/s moves 3 cm in between
/// Most that a column gives way in a press, over the time between presses [m/s]: a tyre that falls at it adds a tenth
/// to its load; at 1 m/s it passes 0.4 m in the time it takes to sink 0.08 m.
constexpr double kSinkSpeed = 0.2;

/// Presses ruts by the laws of terramechanics (plate.h, tyre_patch.h) and keeps what they do not know: the memory.
///
/// Each column remembers the largest pressure it has borne since its surface last changed by other means, so standing
/// still or a second pass at the same load adds nothing. Mass is kept: the column's density state rises. Columns that
/// bear a tyre are held (Ground::hold): the rut's walls do not slump under it [docs/machines.md, ruts].
class Ruts {
 public:
  /// The ground must outlive it.
  explicit Ruts(heightfield::Ground& ground) : ground_(ground) {}

  /// Presses the contact patches of all wheels of the world, each of which carries what of its `force_W` the ground
  /// gave; tyres of a twin pair each carry half. Their columns are held until the next call. No column sinks by more
  /// than `most` [m] at a time: ground that gives way at once lets the wheel fall, and what it hits with presses deeper
  /// than its load would.
  void press(const std::vector<LoadedTyre>& tyres, double most = std::numeric_limits<double>::infinity());

  void visit(Archive& a);

 private:
  struct Memory {
    double pressure = 0;  ///< largest borne [Pa]
    double height = 0;    ///< surface it left behind [m]
    void visit(Archive& a);
  };
  void press_wheel(const scene::Wheel& tyre, const vehicle::WheelState& wheel, double most);
  /// One tyre's patch, its middle `left` [m] of the wheel's centre; `soil` is the one under the wheel.
  void press_patch(const terramechanics::TyrePatch& patch, const scene::Soil& soil, const Pose& X_WWheel, double left,
                   double most);
  /// One column under `pressure` [Pa] of a plate of `width` [m], by its own soil.
  void press_column(int ix, int iy, double pressure, double width, double most);

  heightfield::Ground& ground_;
  std::set<std::int64_t> under_;           ///< columns under the tyres pressed so far in this call
  std::map<std::int64_t, Memory> memory_;  ///< by iy * nx + ix, ordered for repeatability
};

}  // namespace navvy::coupling
