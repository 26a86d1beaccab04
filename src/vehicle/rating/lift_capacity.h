// SPDX-License-Identifier: Apache-2.0
// Lift capacity of an excavator over reach, height and swing [ISO 10567]: the load on the bucket's
// pin that its cylinders lift and that does not tip it. Independent of the physics engine.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/math.h"
#include "scene/machine.h"

namespace navvy::vehicle {

/// Share of the hydraulic lift capacity that a rated lift capacity may use [ISO 10567].
inline constexpr double kHydraulicShare = 0.87;
/// Share of the tipping load that a rated lift capacity may use [ISO 10567].
inline constexpr double kTippingShare = 0.75;

/// Lift capacity in one position of the load.
struct LiftCapacity {
  /// Distance of the load from the swing axis, and its height above the ground [m].
  double reach = 0, height = 0;
  /// Direction of the arm from the machine's x axis, positive to the left [rad].
  double heading = 0;
  /// Positions of the joints of boom and stick [rad].
  double boom = 0, stick = 0;
  /// Load that the first circuit holds at its relief pressure, with the weight of the arm [kg].
  double hydraulic = 0;
  /// Name of the cylinder whose circuit reaches its relief pressure first.
  std::string circuit;
  /// Static tipping load [kg]; infinite if no load tips the machine.
  double tipping = 0;

  /// Returns the rated lift capacity [kg]: the smaller of 87 % of the hydraulic lift capacity and
  /// 75 % of the tipping load.
  double rated() const;
  /// Returns true if the hydraulic lift capacity decides rated().
  bool is_hydraulic() const;
};

/// Computes the lift capacities of one machine.
///
/// The load hangs on the pivot of the bucket. Without the bucket, which is how lift charts are
/// published, its link has no mass; with it, it is curled in and reduces the capacity by its
/// weight. The machine stands on level, firm ground; tyres count as rigid, and an oscillating axle
/// as locked.
class LiftChart {
 public:
  /// Prepares the machine, with or without its bucket. `machine` may be destroyed afterwards.
  /// @throws InputError with tool_force_fault().
  LiftChart(const scene::Machine& machine, bool with_bucket);
  ~LiftChart();

  /// Returns the lift capacity of a load at `reach` from the swing axis and `height` above the
  /// ground [m], with the arm at `heading` [rad] from the machine's x axis; nothing if the arm does
  /// not get there. Of two positions of the arm, the one with the larger rated capacity counts.
  std::optional<LiftCapacity> at(double reach, double height, double heading);
  /// Returns the largest reach at `height`, rounded down to centimetres [m]; nothing if the arm
  /// does not get to that height.
  std::optional<double> max_reach(double height);
  /// Returns the lowest and the highest height of the load [m].
  std::pair<double, double> heights();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace navvy::vehicle
