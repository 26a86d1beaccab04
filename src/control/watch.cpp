// SPDX-License-Identifier: Apache-2.0
#include "control/watch.h"

#include "control/reach.h"

namespace navvy::control {
namespace {

constexpr double kFarthestTilt = radians(45);  // no wheeled machine comes back from there by itself
// A wheel that hits a stone rocks the machine by more than this only for moments.
constexpr double kTiltRate = 0.05;  // [rad/s]
constexpr double kOutside = 0.2;    // [s]

}  // namespace

bool is_off_site(const heightfield::Terrain& site, const Vec3& p_W) {
  const Vec2i at = site.column_at(p_W.x(), p_W.y());
  return !site.contains(at.x(), at.y());
}

StepState Watch::look(const Observation& seen, double dt, std::string& reason) {
  const vehicle::Stability& stands = seen.stability;
  if (!stands.free) return StepState::kRunning;
  const std::string tilt = "it tilts by " + number_text(degrees(stands.tilt), "deg");
  const std::string outside =
      "its centre of mass is " + metres(-stands.margin) + " outside its support polygon";
  outside_ = stands.margin < 0 && stands.tilt_rate > kTiltRate ? outside_ + dt : 0;
  if (stands.tilt > kFarthestTilt || outside_ > kOutside) {
    reason = stands.margin < 0 ? outside + " and " + tilt : tilt;
    return StepState::kTipped;
  }
  if (seen.wheels_under >= 0.5) {
    reason = "the ground is over the tops of " + number_text(100 * seen.wheels_under, "%") +
             " of its wheels";
    return StepState::kBuried;
  }
  return StepState::kRunning;
}

}  // namespace navvy::control
