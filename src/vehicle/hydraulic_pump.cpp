// SPDX-License-Identifier: Apache-2.0
#include "vehicle/hydraulic_pump.h"

#include <algorithm>
#include <cmath>

namespace navvy::vehicle {
namespace {

constexpr double kOpenTime = 0.15;  // [s] from 0 to 1, as a valve (joint_servo.cpp)
constexpr double kSwashTime = 0.3;  // [s] tuned: BulletPump.LiftsWithItsPower oscillates at 0.1

}  // namespace

// The heaviest load sets the pressure, which with the power limits the flow.
double HydraulicPump::share(const scene::Pump& pump, const std::vector<OilDemand>& demands,
                            double dt) {
  double asked = 0, load = 0;
  for (const OilDemand& demand : demands) {
    asked += demand.flow;
    load = std::max(load, demand.pressure);
  }
  pressure_ += (1 - std::exp(-dt / kSwashTime)) * (load - pressure_);
  // flow x pressure <= power, without dividing by a pressure of zero.
  const double most = pump.flow * pressure_ > pump.power ? pump.power / pressure_ : pump.flow;
  // Oil that becomes available reaches the other functions no faster than their valves open.
  share_ = std::min(asked > most ? most / asked : 1.0, share_ + dt / kOpenTime);
  return share_;
}

void HydraulicPump::visit(Archive& a) {
  a("flow", flow_);
  a("pressure", pressure_);
  a("share", share_);
}

}  // namespace navvy::vehicle
