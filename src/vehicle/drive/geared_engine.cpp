// SPDX-License-Identifier: Apache-2.0
#include "vehicle/drive/geared_engine.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"

namespace navvy::vehicle {
namespace {

// [s] tuned: GearedEngine.ChoosesTheHighestGearThatPullsAndDoesNotHunt
constexpr double kDwell = 1;
constexpr double kSpare = 1.25;     // tuned: same
constexpr double kAboveIdle = 1.1;  // [-] tuned: paper/ackermann changes up and back at 1
// [-] Range above the governed speed in which the torque falls to zero (U).
constexpr double kDroop = 0.04;
// [-] Share of idle speed below which the governor supplies the engine's own drag.
constexpr double kDragFrom = 1.25;

bool sources(const scene::CombustionEngine& engine) {
  return engine.kind == scene::CombustionEngine::Kind::kSpeedSource;
}

}  // namespace

GearedEngine::GearedEngine(scene::CombustionEngine about, bool drives_pump)
    : about_(std::move(about)), held_(kDwell) {
  if (about_.gears.empty() || (!sources(about_) && about_.curve.size() < 2))
    throw InputError(Fault{
        Fault::Severity::kError, "", 0, "engine", "",
        "needs at least one gear and, unless it is a speed source, two points of its torque curve",
        ""});
  if (sources(about_)) return;
  slowest_ = drives_pump ? scene::rated_point(about_).speed : about_.curve.front().speed;
}

double GearedEngine::ratio(int gear) const {
  return about_.final_ratio * about_.gears[static_cast<std::size_t>(gear - 1)];
}

double GearedEngine::fastest(int command) const {
  if (sources(about_)) return about_.max_speed / ratio(std::clamp(command, 1, count()));
  return about_.curve.back().speed / ratio(command > 0 ? std::min(command, count()) : count());
}

// Interpolates the curve and fades out above the governed speed.
double GearedEngine::full_torque(double speed) const {
  const auto& curve = about_.curve;
  if (speed <= curve.front().speed) return curve.front().torque;
  for (std::size_t i = 1; i < curve.size(); ++i) {
    if (speed > curve[i].speed) continue;
    const double share = (speed - curve[i - 1].speed) / (curve[i].speed - curve[i - 1].speed);
    return curve[i - 1].torque + share * (curve[i].torque - curve[i - 1].torque);
  }
  return curve.back().torque * std::max(0.0, 1 - (speed / curve.back().speed - 1) / kDroop);
}

double GearedEngine::drag(double shaft) const {
  const double idle = about_.curve.front().speed;
  return about_.braking_torque * std::clamp((shaft / idle - 1) / (kDragFrom - 1), 0.0, 1.0);
}

double GearedEngine::engine_speed(double shaft) const { return std::max(slowest_, shaft); }

double GearedEngine::pull(int gear, double carrier) const {
  return ratio(gear) * about_.efficiency * full_torque(engine_speed(ratio(gear) * carrier));
}

double GearedEngine::hold(int gear, double carrier) const {
  return ratio(gear) / about_.efficiency * drag(ratio(gear) * carrier);
}

bool GearedEngine::fits(int gear, double carrier) const {
  const double shaft = ratio(gear) * carrier;
  // A gear that was just engaged should not have to be left at once.
  const double least = about_.curve.front().speed * (gear > gear_ ? kAboveIdle : 1);
  const double most = about_.curve.back().speed * (gear < gear_ ? 1 : 1 + kDroop);
  // The first gear may slip and the last one overspeed: there are no others beyond.
  return (gear == 1 || shaft >= least) && (gear == count() || shaft <= most);
}

// Tries the gears from the highest down.
void GearedEngine::shift(int command, double carrier, double torque, double dt) {
  held_ = std::min(held_ + dt, kDwell);
  int next = gear_;
  const auto has = [&](int gear) { return torque < 0 ? hold(gear, carrier) : pull(gear, carrier); };
  if (command > 0 || sources(about_)) {
    next = std::clamp(command, 1, count());
  } else if (held_ >= kDwell || !fits(gear_, carrier)) {
    // To shift up, the present torque is enough: while the machine is slower than commanded, the
    // governor asks for more than it needs to keep its speed.
    const double up = kSpare * std::min(std::abs(torque), has(gear_));
    double most = -1;
    for (int gear = count(); gear > 0; --gear) {
      if (!fits(gear, carrier)) continue;
      if (has(gear) > most) next = gear, most = has(gear);
      if (has(gear) >= (gear > gear_ ? up : std::abs(torque))) break;
    }
  }
  if (next != gear_) held_ = 0;
  gear_ = next;
}

// Both limits at the carrier, from the engine's through the engaged gear.
GearedEngine::Bounds GearedEngine::bounds(double carrier, double pump_power) const {
  const double r = ratio();
  if (sources(about_))
    return {-r / about_.efficiency * about_.max_torque, r * about_.efficiency * about_.max_torque};
  const double speed = engine_speed(r * carrier);
  // The pump takes its part of the curve's torque.
  const double torque = std::max(0.0, full_torque(speed) - pump_power / speed);
  return {-hold(gear_, carrier), r * about_.efficiency * torque};
}

// Converts back from the carrier to the engine's shaft.
CombustionEngineState GearedEngine::state(double carrier, double torque, double pump_power) const {
  CombustionEngineState out;
  out.gear = gear_;
  const double loss = torque > 0 ? 1 / about_.efficiency : about_.efficiency;
  const double shaft = torque / ratio() * loss;
  out.speed = sources(about_) ? ratio() * carrier : engine_speed(ratio() * carrier);
  out.torque = shaft + (out.speed > 0 ? pump_power / out.speed : 0);
  out.power = out.torque * out.speed;
  return out;
}

void GearedEngine::visit(Archive& a) {
  a.ranged("gear", gear_, 1, count());
  a.ranged("held", held_, 0.0, kDwell);
}

}  // namespace navvy::vehicle
