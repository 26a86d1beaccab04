// SPDX-License-Identifier: Apache-2.0
// Pump that feeds all cylinders of a machine, and its distribution of oil. Independent of any
// engine.
#pragma once

#include <vector>

#include "core/archive.h"
#include "scene/machine.h"

namespace navvy::vehicle {

/// Demand of one hydraulic function in a step.
struct OilDemand {
  /// Flow that its valve would pass with enough oil [m3/s].
  double flow = 0;
  double pressure =
      /// Load against the commanded motion [Pa]; 0 when the load assists, or while the function
      /// holds or stalls.
      0;
};

/// Load-sensing pump with flow sharing, as on wheeled excavators (LUDV and similar).
///
/// It delivers what the valves pass, at the pressure of the function with the heaviest load. If
/// that exceeds its flow, or its power at that pressure, all functions are slowed by the same
/// share. A function that holds or stalls hardly opens its valve: it neither takes oil nor
/// determines the pressure. Lowering takes oil like lifting; nothing is regenerated. The swashplate
/// lags behind the load: for some 0.3 s after a load rises, the pump may exceed its power. Steps
/// must not exceed 5 ms: in longer ones a stalled valve opens noticeably.
class HydraulicPump {
 public:
  /// Returns the share of the demanded flow that every function gets in this step, 0 to 1.
  double share(const scene::Pump& pump, const std::vector<OilDemand>& demands, double dt);
  /// Records the flow that the functions took in the step [m3/s].
  void settle(double flow) { flow_ = flow; }

  /// Returns the flow in the last step [m3/s].
  double flow() const { return flow_; }
  /// Pressure that the swashplate follows, smoothed [Pa].
  double pressure() const { return pressure_; }

  /// Visits flow, pressure and share.
  void visit(Archive& a);

 private:
  double flow_ = 0, pressure_ = 0;
  double share_ = 1;  // in the last step
};

}  // namespace navvy::vehicle
