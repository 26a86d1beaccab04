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
  /// Flow that the valve would pass if there were enough oil [m3/s].
  double flow = 0;
  /// Pressure of the load that opposes the commanded motion [Pa]; 0 while the load assists the
  /// motion, or while the joint holds or stalls.
  double pressure = 0;
};

/// Load-sensing pump with flow sharing (LUDV and similar systems), as on wheeled excavators. A
/// hydraulic function is a joint with its cylinders and valve.
///
/// The pump delivers the flow that the valves pass, at the pressure of the hydraulic function with
/// the heaviest load. If this exceeds the pump's flow, or its power at that pressure, all hydraulic
/// functions are slowed by the same factor. A joint that holds or stalls hardly opens its valve, so
/// it neither takes oil nor determines the pressure. Lowering takes as much oil as lifting; no
/// energy is recovered.
///
/// The swashplate lags behind the load: for about 0.3 s after a load rises, the pump may exceed its
/// power. Steps must not exceed 5 ms; in longer ones the valve of a stalled joint would open
/// noticeably.
class HydraulicPump {
 public:
  /// Returns the share, 0 to 1, of its demanded flow that every hydraulic function gets in this
  /// step, and advances the pressure that the swashplate follows by `dt` [s].
  ///
  /// `pump` has the limits of flow and power; `demands` has one entry per hydraulic function. Call
  /// it once per step.
  double share(const scene::Pump& pump, const std::vector<OilDemand>& demands, double dt);
  /// Records the total flow [m3/s] that all hydraulic functions took in this step. Call it after
  /// the solver.
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
  /// Share of its demanded flow that every hydraulic function got in the last step [-].
  double share_ = 1;
};

}  // namespace navvy::vehicle
