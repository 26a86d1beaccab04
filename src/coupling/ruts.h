// SPDX-License-Identifier: Apache-2.0
// Wheel ruts: columns under a tyre are pressed to the sinkage of their soil.
#pragma once

#include <cstdint>
#include <limits>
#include <set>
#include <vector>

#include "core/archive.h"
#include "coupling/column_table.h"
#include "coupling/pushed_soil.h"
#include "coupling/rut_memory.h"
#include "heightfield/layered_ground.h"
#include "scene/machine.h"
#include "terramechanics/ground_query.h"
#include "terramechanics/tyre_patch.h"
#include "vehicle/physics_engine.h"

namespace navvy::coupling {

/// One wheel, referred to, and how it stands.
struct LoadedTyre {
  const scene::Wheel& tyre;
  vehicle::WheelState wheel;
};

/// Steps between presses; a wheel at 2.5 m/s moves 3 cm in between.
constexpr int kRutInterval = 8;

/// Presses ruts by the laws of terramechanics (plate.h, tyre_patch.h) and keeps what they do not
/// know: the memory.
///
/// Each column remembers the largest pressure it has borne (RutMemory), so standing still or a
/// second pass at the same load adds nothing. Mass is kept: the column's density state rises, and
/// what the ground cannot bear (terramechanics::pushed_depth) flows aside onto the rut's edges.
/// Columns that bear a tyre are held (Ground::hold): the rut's walls do not slump under it
/// [docs/machines.md, ruts].
///
/// What a wheel presses with is its load of the last 0.3 s and its slip over the last radius of
/// way: a tyre that bounces does not press its bounces into the ground, which it would feel as a
/// washboard, the ground does not give way at once under what falls on it, and a wheel that starts
/// has carried no soil away yet.
class Ruts {
 public:
  /// The ground must outlive it.
  explicit Ruts(heightfield::Ground& ground)
      : ground_(ground), pushed_(ground), memory_(ground.nx(), ground.ny()) {}

  /// Presses the contact patches of all wheels of the world, in the same order each time, as they
  /// are and where they roll within `interval` [s], the time until the next call. Each carries what
  /// of its `force_W` the ground gave; tyres of a twin pair each carry half. Their columns are held
  /// until the next call. With an endless interval loads count as they are.
  void press(const std::vector<LoadedTyre>& tyres,
             double interval = std::numeric_limits<double>::infinity());

  /// What pressing the column at x, y took since a tyre came onto it; nothing where none stands.
  terramechanics::Sinkage sinking(double x, double y) const;

  /// What a column of the site has borne of tyres and belts, made if it has borne nothing. Good
  /// until the next call.
  RutMemory& borne(int ix, int iy) { return memory_.at(ix, iy).borne; }

  /// Load [N] that wheel `i` of the last call's presses with, 0 before.
  double load(std::size_t i) const { return i < bearing_.size() ? bearing_[i].load : 0; }

  void visit(Archive& a);

 private:
  struct Memory {
    RutMemory borne;
    terramechanics::Sinkage sinking;  ///< since the tyre that stands on it came
    void visit(Archive& a);
  };
  /// How a wheel loads the ground, low-passed.
  struct Bearing {
    double load = 0;  ///< [N]
    double slip = 0;  ///< [-]
    void follow(const scene::Wheel& tyre, const vehicle::WheelState& wheel, double interval);
    void visit(Archive& a);
  };
  /// A tyre's patch on the soil that decides its size.
  struct Press {
    terramechanics::TyrePatch patch;
    const scene::Soil& soil;
    double softer;  ///< by slip: sinkage over that without
  };
  void press_wheel(const scene::Wheel& tyre, const vehicle::WheelState& wheel,
                   const Bearing& bearing, double interval);
  /// One tyre's patch, its middle at `center`, along the unit vector `along`, `aside` [m] left of
  /// the wheel's middle.
  void press_patch(const Press& press, const Vec2& center, const Vec2& along, double aside);
  /// One column under `pressure` [Pa], by its own soil.
  void press_column(const PushedSoil::Place& place, double pressure, const Press& press);

  heightfield::Ground& ground_;
  PushedSoil pushed_;             ///< empty between two calls
  std::set<std::int64_t> under_;  ///< columns under the tyres pressed so far in this call
  ColumnTable<Memory> memory_;
  std::vector<Bearing> bearing_;  ///< by wheel of the world
};

}  // namespace navvy::coupling
