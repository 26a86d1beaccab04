// SPDX-License-Identifier: Apache-2.0
// Pump that feeds all cylinders of a machine, and the distribution of its oil. Independent of the
// physics engine.
#pragma once

#include <vector>

#include "core/archive.h"
#include "scene/machine.h"

namespace navvy::vehicle {

/// Demand of one hydraulic function (a joint with its cylinders and valve) for oil in one step.
struct OilDemand {
  /// Flow that the function's valve would pass if there were enough oil [m3/s].
  double flow = 0;
  /// Pressure of the load that opposes the commanded motion [Pa]; 0 while the load assists the
  /// motion, or while the function holds or stalls.
  double pressure = 0;
};

/// Load-sensing pump with flow sharing (LUDV and similar systems), as on wheeled excavators.
///
/// The pump delivers the flow that the valves pass, at the pressure of the function with the
/// heaviest load. If this exceeds the pump's flow, or its power at that pressure, all functions are
/// slowed by the same factor. A function that holds or stalls hardly opens its valve, so it neither
/// takes oil nor determines the pressure. Lowering takes as much oil as lifting; no energy is
/// recovered.
///
/// The swashplate lags behind the load: for about 0.3 s after a load rises, the pump may exceed its
/// power. Steps must not exceed 5 ms; in longer ones the valve of a stalled function would open
/// noticeably.
class HydraulicPump {
 public:
  /// Computes the share of its demanded flow that every function gets in this step, 0 to 1, and
  /// advances the pressure that the swashplate follows by `dt` [s].
  ///
  /// `pump` has the limits of flow and power; `demands` has one entry per hydraulic function. Call
  /// it once per step.
  double share(const scene::Pump& pump, const std::vector<OilDemand>& demands, double dt);
  /// Records the total flow [m3/s] that the functions took in this step. Call it after the solver.
  void settle(double flow) { flow_ = flow; }

  /// Returns the total flow into the cylinders in the last step [m3/s].
  double flow() const { return flow_; }
  /// Returns the smoothed pressure that the swashplate follows [Pa].
  double pressure() const { return pressure_; }

  /// Saves, loads or hashes the pump's flow, pressure and share.
  void visit(Archive& a);

 private:
  /// Flow in the last step [m3/s], and smoothed pressure [Pa].
  double flow_ = 0, pressure_ = 0;
  /// Share of its demanded flow that every function got in the last step.
  double share_ = 1;
};

}  // namespace navvy::vehicle
