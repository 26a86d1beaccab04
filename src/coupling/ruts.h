// SPDX-License-Identifier: Apache-2.0
// Ruts of wheels: the ground columns under a tyre are pressed down by the sinkage of their soil.
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

/// A wheel with a tyre, and its current state.
struct LoadedTyre {
  /// Description of the wheel.
  const scene::Wheel& tyre;
  /// State of the wheel, including the force on it.
  vehicle::WheelState wheel;
};

/// Number of base steps from one press of the ruts to the next. In this time a wheel at 2.5 m/s
/// moves by 3 cm.
constexpr int kRutInterval = 8;

/// Presses ruts with the laws of terramechanics (plate.h, tyre_patch.h) and stores the load history
/// of every pressed column.
///
/// Each column stores the maximum pressure on it (RutMemory), so a load that stands still or passes
/// again does not press deeper. Mass is conserved: the column becomes denser, and soil that is
/// loaded beyond its bearing capacity (terramechanics::pushed_depth) flows to the edges of the rut.
/// Columns under a tyre are held (Ground::hold): the walls of the rut do not slump into them
/// [docs/machines.md, ruts].
///
/// The load is averaged over 0.3 s, and the slip over a distance of one wheel radius. This prevents
/// a bouncing tyre from pressing a washboard pattern, and a wheel that has just started to spin
/// from excavating at once.
class Ruts {
 public:
  /// Makes an object without load history. The ground must outlive it.
  explicit Ruts(heightfield::Ground& ground)
      : ground_(ground), pushed_(ground), memory_(ground.nx(), ground.ny()) {}

  /// Presses the ground under the contact patches of all wheels of the world, at the current
  /// positions and at those that the wheels reach within `interval` [s], the time until the next
  /// call.
  ///
  /// Pass the same wheels in the same order in every call. Each wheel presses with the part of its
  /// `force_W` that the ground carries; each tyre of a twin pair carries half of it. The columns
  /// under the tyres are held until the next call. With an infinite interval, the current loads are
  /// used without averaging.
  void press(const std::vector<LoadedTyre>& tyres,
             double interval = std::numeric_limits<double>::infinity());

  /// Returns the compaction of the column that contains the point (x, y) in W [m] since the tyre on
  /// it arrived; zero if there is no tyre.
  terramechanics::Sinkage sinking(double x, double y) const;

  /// Returns the load history of a column, and creates it if there is none. The reference is valid
  /// until the next call.
  RutMemory& history(int ix, int iy) { return memory_.at(ix, iy).history; }

  /// Returns the averaged load [N] of the wheel with index `i` in the list passed to the last call
  /// of `press`; 0 before the first call.
  double load(std::size_t i) const { return i < bearing_.size() ? bearing_[i].load : 0; }

  /// Saves or loads the load history and the averaged loads.
  void visit(Archive& a);

 private:
  // Load history of a column, and its compaction under the current tyre.
  struct Memory {
    // Load history of the column.
    RutMemory history;
    // Compaction since the tyre on the column arrived; meaningless without a tyre.
    terramechanics::Sinkage sinking;
    // Saves or loads the load history and the compaction.
    void visit(Archive& a);
  };
  // Averaged load and slip of a wheel.
  struct Bearing {
    // Averaged vertical force of the wheel on the ground [N].
    double load = 0;
    // Averaged slip [-].
    double slip = 0;
    // Updates the averages with the state of the wheel after `interval` [s].
    void follow(const scene::Wheel& tyre, const vehicle::WheelState& wheel, double interval);
    // Saves or loads the averages.
    void visit(Archive& a);
  };
  // Contact patch of a tyre on the soil under the wheel's middle, which determines the size of the
  // patch.
  struct Press {
    // Dimensions and pressure of the contact patch.
    terramechanics::TyrePatch patch;
    // Soil under the middle of the wheel.
    const scene::Soil& soil;
    // Factor by which slip increases the sinkage [-].
    double softer;
  };
  // Presses the ground under the contact patches of one wheel, at its current position and at that
  // after `interval` [s].
  void press_wheel(const scene::Wheel& tyre, const vehicle::WheelState& wheel,
                   const Bearing& bearing, double interval);
  // Presses the ground under one tyre. `center` is the middle of the contact patch (x, y in W [m]),
  // `along` the unit vector of its heading, and `aside` the distance of the tyre to the left of the
  // wheel's middle [m].
  void press_patch(const Press& press, const Vec2& center, const Vec2& along, double aside);
  // Presses one column with `pressure` [Pa] by the law of its own soil.
  void press_column(const PushedSoil::Place& place, double pressure, const Press& press);

  // Ground that is pressed.
  heightfield::Ground& ground_;
  // Soil displaced during a call of `press`; empty between two calls.
  PushedSoil pushed_;
  // Columns (iy * nx + ix) under the tyres pressed so far in this call of `press`.
  std::set<std::int64_t> under_;
  // Load history and compaction of every column pressed so far.
  ColumnTable<Memory> memory_;
  // Averages of each wheel, in the order of the wheels passed to `press`.
  std::vector<Bearing> bearing_;
};

}  // namespace navvy::coupling
