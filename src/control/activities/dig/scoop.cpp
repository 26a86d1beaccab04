// SPDX-License-Identifier: Apache-2.0
// Tip paths of a scoop in the vertical plane of the trench: down, along, curl.
#include <algorithm>
#include <cmath>
#include <string>

#include "control/activities/dig/digging.h"
#include "control/dig_pose.h"
#include "control/profile.h"

namespace navvy::control {
namespace {

constexpr double kDownAir = 0.9, kDownSoil = 0.45;  // [m/s]
constexpr double kDragSpeed = 0.7;                  // [m/s]
constexpr double kTurnIn = 0.9;                     // of the bucket while dragging [rad/s]
// Difference from its digging angle at which a bucket may curl [rad].
constexpr double kTurnedIn = radians(5);
constexpr double kCurlTime = 2.2;  // [s]
// The edge cuts on at this speed [m/s] in this first share of the curl, if the bucket has this
// share of a load; with less it only scrapes. Held by rock it stands still (TipPath::slow). tuned:
// on the trench, with kAboutPin, 0.5 m/s until 0.6 retains 361 kg, 0.7 m/s until 0.7 retains 397
// kg.
constexpr double kCurlSpeed = 0.7, kCutOn = 0.7, kFair = 0.5;
// A curl on the spot pours out soil, so this much of the path to the near end is left to it,
// whatever the load. tuned: on a trench 1.6 m deep, passes along the floor that dragged on to the
// end lost 190 of 250 kg in the curl.
constexpr double kCurlPath = 0.6;  // [m]
// The bucket rotates by this share about its pin and by the rest about its edge. About the edge,
// the heel presses on the floor that was just cut and the boom pushes it down. tuned: on the
// trench's first scoop the soil pushes the bucket up by 40, 24, 1 and 1 kN at 0, 0.4, 0.6 and 1,
// and the load is 415, 400, 361 and 344 kg.
constexpr double kAboutPin = 0.6;
constexpr double kOut = 0.25;      // lowest point over the surface after the curl [m]
constexpr double kPastEnd = 0.03;  // the shell may pass the far end by this [m]
// The drag continues by this beyond its planned end when the bucket is not full [m].
constexpr double kMore = 0.5;
// Raised by this on the way down, the scoop continues at that depth [m].
constexpr double kPenetrateLift = 0.12;
constexpr double kPhaseLimit = 12;  // [s]

}  // namespace

bool Digging::overdue(double limit) const {
  if (phase_time() <= limit) return false;
  place_.warn(std::string(phase()) + " took more than " + std::to_string(static_cast<int>(limit)) +
              " s, going on with the cycle");
  return true;
}

double Digging::floor_height() const {
  return plan_.start_height(m.s) - m.scoop_level + arm_.below_tip(m.tip.reached);
}

void Digging::follow_tip(const Observation& seen, double dt) {
  m.tip.follow(place_, m.stance, plan_.point(m.s), seen, dt, phase_index() == kCurl);
}

void Digging::penetrate(const Observation& seen, double dt) {
  // Fast through air; the last ten centimetres count as soil.
  const bool in_air = m.tip.z > plan_.start_height(m.s) + 0.1;
  const double goal = floor_height();
  m.tip.z = std::max(goal, m.tip.z - (in_air ? kDownAir : kDownSoil) * m.tip.slow * dt);
  follow_tip(seen, dt);
  // Soil that holds the tip on the way down is dug at the depth it allows.
  if (m.tip.z <= goal || m.tip.lift > kPenetrateLift || overdue(kPhaseLimit)) {
    m.lift_before = m.tip.lift;
    m.held_up = 0;
    enter(kDrag);
  }
}

bool Digging::drag(const Observation& seen, double dt) {
  const double gone = m.s - std::max(0.0, m.s - kDragSpeed * m.tip.slow * dt);
  m.s -= gone;
  m.held_up += std::max(0.0, m.tip.lift - m.lift_before) * gone;
  // The bucket rotates to its digging angle as soon as its back is clear of the far end.
  const double wish = with_cut(arm_, -kPi + kAttack),
               turned = std::max(wish, m.tip.angle - kTurnIn * m.tip.slow * dt);
  const double depth = plan_.start_height(m.s) - m.tip.z - m.tip.lift;
  if (plan_.length() - m.s + kPastEnd >= arm_.beyond_tip(turned, depth)) m.tip.angle = turned;
  m.tip.z = std::max(floor_height(), m.tip.z - kDownSoil * m.tip.slow * dt);
  follow_tip(seen, dt);
  // Before it has rotated, its heel is at the far end, and the curl would press it into the wall.
  const bool full = seen.payload >= m.full_mass && m.tip.angle <= wish + kTurnedIn;
  const bool planned =
      m.s <= m.scoop_end && (seen.payload > 0.8 * m.full_mass || m.s <= m.scoop_end - kMore);
  if (!(full || planned || m.s <= std::min(kCurlPath, 0.5 * m.scoop_start) || overdue(kPhaseLimit)))
    return false;
  // The curl begins where the arm is, not where it was commanded to be.
  m.curl_angle = m.tip.angle = m.tip.reached;
  m.curl_z = m.tip.z = m.tip.z + m.tip.lift;
  m.tip.lift = 0;
  m.progress = 0;
  return true;
}

bool Digging::curl(const Observation& seen, double dt) {
  // A held bucket still curls, slowly; one that tips the machine waits.
  const double least = m.stance.tilt_factor(seen.X_WB) < 1 ? 0 : 0.1;
  m.progress = std::min(1.0, m.progress + std::max(least, m.tip.slow) * dt / kCurlTime);
  if (m.progress < kCutOn && (seen.payload > kFair * m.full_mass || m.s <= kCurlPath))
    m.s = std::max(0.0, m.s - kCurlSpeed * m.tip.slow * dt);
  m.tip.angle = mix(m.curl_angle, kCarry, smooth(m.progress / 0.8));
  const double arc = arm_.bucket_length() * (std::sin(m.tip.reached) - std::sin(m.curl_angle));
  const double turned = std::max(m.curl_z + std::max(0.0, kAboutPin * arc), floor_height());
  // First the bucket rotates; then it leaves the ground straight up.
  const double top = plan_.start_height(m.s) + kOut + arm_.below_tip(m.tip.reached);
  m.tip.z = mix(turned, std::max(turned, top), smooth((m.progress - 0.35) / 0.65));
  follow_tip(seen, dt);
  return m.progress >= 1 || overdue(kPhaseLimit);
}

}  // namespace navvy::control
