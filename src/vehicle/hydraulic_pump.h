// SPDX-License-Identifier: Apache-2.0
// One pump for all cylinders of a machine: who gets how much oil. Knows no engine.
#pragma once

#include <vector>

#include "core/archive.h"
#include "scene/machine.h"

namespace navvy::vehicle {

/// What one hydraulic function asks of the pump in a step.
struct OilDemand {
  double flow = 0;  ///< that its valve would pass if there were oil enough [m3/s]
  double pressure =
      /// Its load against the motion asked for; 0 when the load helps, or while it holds or stalls
      /// [Pa].
      0;
};

/// A load-sensing pump with flow sharing, as on wheeled excavators (LUDV and its kin).
///
/// It delivers what the valves let through, at the pressure of the function with the heaviest load.
/// When that is more than its flow, or than its power at that pressure, all functions are slowed by
/// the same share. A function that only holds, or that stalls, opens its valve hardly at all and
/// neither takes oil nor sets the pressure. Lowering takes oil like lifting; nothing is
/// regenerated. The swashplate lags behind the load: for some 0.3 s after a load came it may give
/// more than its power. Meant for steps of up to 5 ms: in longer ones a stalled valve opens by more
/// than a trifle.
class HydraulicPump {
 public:
  /// Share of the asked flow that every function gets in this step, 0 to 1.
  double share(const scene::Pump& pump, const std::vector<OilDemand>& demands, double dt);
  /// Tells what the functions took in the step [m3/s].
  void settle(double flow) { flow_ = flow; }

  double flow() const { return flow_; }          ///< delivered in the last step [m3/s]
  double pressure() const { return pressure_; }  ///< as the swashplate sees it: smoothed [Pa]

  void visit(Archive& a);

 private:
  double flow_ = 0, pressure_ = 0;
  double share_ = 1;  // in the last step
};

}  // namespace navvy::vehicle
