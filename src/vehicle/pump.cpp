// SPDX-License-Identifier: Apache-2.0
#include "vehicle/pump.h"

#include <algorithm>
#include <cmath>

namespace navvy::vehicle {
namespace {

constexpr double kSwashTime = 0.3;  // [s] tuned: BulletPump.LiftsWithItsPower hunts at 0.1
constexpr double kLoading = 0.05;   // of its full flow: functions that take less hold or stall, and set no pressure

}  // namespace

double Pump::share(const scene::Pump& pump, const std::vector<OilDemand>& demands, double dt) {
  double asked = 0, load = 0;
  for (const OilDemand& demand : demands) {
    asked += demand.flow;
    if (demand.flow > kLoading * demand.full_flow) load = std::max(load, demand.pressure);
  }
  pressure_ += (1 - std::exp(-dt / kSwashTime)) * (load - pressure_);
  // flow x pressure <= power, without dividing by a pressure of zero.
  const double most = pump.flow * pressure_ > pump.power ? pump.power / pressure_ : pump.flow;
  return asked > most ? most / asked : 1.0;
}

void Pump::hash(StateHash& hash) const {
  hash.value(flow_);
  hash.value(pressure_);
}

void Pump::save(StateWriter& writer) const {
  writer.value(flow_);
  writer.value(pressure_);
}

void Pump::load(StateReader& reader) {
  flow_ = reader.value<double>();
  pressure_ = reader.value<double>();
}

}  // namespace navvy::vehicle
