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

/// A wheel and its state.
struct LoadedTyre {
  const scene::Wheel& tyre;
  vehicle::WheelState wheel;
};

/// Base steps between two presses. A wheel at 2.5 m/s moves 3 cm in between.
constexpr int kRutInterval = 8;

/// Presses ruts by the laws of terramechanics (plate.h, tyre_patch.h) and stores their load
/// history.
///
/// Each column records its largest pressure (RutMemory), so a load that stands still
/// or passes again adds nothing. Mass is conserved: the column's density rises, and soil beyond the
/// bearing capacity (terramechanics::pushed_depth) flows onto the rut's edges. Columns under a tyre
/// are held (Ground::hold): the rut's walls do not slump below it [docs/machines.md, ruts].
///
/// The load is averaged over the last 0.3 s and the slip over the last radius travelled. A bouncing
/// tyre therefore presses no washboard, the ground does not yield at once under a falling load, and
/// a starting wheel has not excavated yet.
class Ruts {
 public:
  /// Starts without ruts. The ground must outlive this object.
  explicit Ruts(heightfield::Ground& ground)
      : ground_(ground), pushed_(ground), memory_(ground.nx(), ground.ny()) {}

  /// Presses the contact patches of all wheels of the world where they are and where they roll
  /// within `interval` [s], the time until the next call. Pass the wheels in the same order each
  /// time. Each wheel presses with the part of its `force_W` that the ground carries; tyres of a
  /// twin pair carry half each. Columns under tyres are held until the next call. With an infinite
  /// interval loads are not averaged.
  void press(const std::vector<LoadedTyre>& tyres,
             double interval = std::numeric_limits<double>::infinity());

  /// Returns the compaction of the column at x, y since a tyre arrived on it; zero without a tyre.
  terramechanics::Sinkage sinking(double x, double y) const;

  /// Returns the load history of a column and creates it if it is new. The reference is valid until
  /// the next call.
  RutMemory& history(int ix, int iy) { return memory_.at(ix, iy).history; }

  /// Returns the load [N] with which wheel `i` of the last call presses, 0 before.
  double load(std::size_t i) const { return i < bearing_.size() ? bearing_[i].load : 0; }

  /// Visits load history and filtered loads.
  void visit(Archive& a);

 private:
  /// Load history of a column and its present compaction.
  struct Memory {
    RutMemory history;
    /// Compaction since the tyre that stands on the column arrived.
    terramechanics::Sinkage sinking;
    void visit(Archive& a);
  };
  /// Low-pass filtered load of a wheel on the ground.
  struct Bearing {
    double load = 0;  ///< [N]
    double slip = 0;  ///< [-]
    void follow(const scene::Wheel& tyre, const vehicle::WheelState& wheel, double interval);
    void visit(Archive& a);
  };
  /// Patch of a tyre on the soil that determines its size.
  struct Press {
    terramechanics::TyrePatch patch;
    const scene::Soil& soil;
    /// Factor of the sinkage by slip.
    double softer;
  };
  /// Presses the patches of one wheel where it is and where it rolls next.
  void press_wheel(const scene::Wheel& tyre, const vehicle::WheelState& wheel,
                   const Bearing& bearing, double interval);
  /// Presses the patch of one tyre with its middle at `center`, along the unit vector `along`,
  /// `aside` [m] left of the wheel's middle.
  void press_patch(const Press& press, const Vec2& center, const Vec2& along, double aside);
  /// Presses one column with `pressure` [Pa], by the law of its own soil.
  void press_column(const PushedSoil::Place& place, double pressure, const Press& press);

  heightfield::Ground& ground_;
  /// Empty between two calls.
  PushedSoil pushed_;
  /// Columns under the tyres pressed so far in this call.
  std::set<std::int64_t> under_;
  ColumnTable<Memory> memory_;
  /// Filtered loads by wheel of the world.
  std::vector<Bearing> bearing_;
};

}  // namespace navvy::coupling
