// SPDX-License-Identifier: Apache-2.0
// Tip paths of a scoop in the vertical plane of the trench: down, along, curl.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "control/activities/dig/digging.h"
#include "control/dig_pose.h"
#include "control/profile.h"

namespace navvy::control {
namespace {

// Speeds down through air and soil, and of the drag [m/s]; rate of the bucket while dragging
// [rad/s]; time in which drag and turn begin [s].
constexpr double kDownAir = 1.1, kDownSoil = 0.6, kDragSpeed = 0.9;
constexpr double kTurnIn = 1.2, kStartTime = 0.4;
// Deceleration on the way down [m/s2] to this speed at the floor [m/s].
constexpr double kDownBrake = 1.5, kDownCreep = 0.1;
// In the air, so far above the ground [m], the tip moves along the trench at this speed [m/s] to a
// start this near [m].
constexpr double kNearGround = 0.1, kAlong = 0.8, kAtStart = 0.03;
// Swing beside the line, and its speed, at which a bucket may go down between the edges [rad],
// [rad/s]; at a reach of 7 m the bucket is 3 cm aside.
constexpr double kAside = 0.004, kSwingRest = 0.02;
// Time after which the bucket goes down although the swing is still aside, as on a slope [s].
constexpr double kSwingPatience = 2;
// Difference from its digging angle at which a bucket may curl [rad].
constexpr double kTurnedIn = radians(5);
// Share of the wanted load at which the curl begins: the edge cuts on, and the heap in front of the
// mouth falls off when the tip leaves the ground. tuned: on the trench, at 0.85 / 0.97 four scoops
// bring 840 / 880 kg.
constexpr double kCurlAt = 0.93;
// The edge cuts on at this speed [m/s] in the first part of the curl, if the bucket has this share
// of a load; with less it only scrapes. Held by rock it stands still (TipPath::slow). tuned: on the
// trench 0.4, 0.6 and 0.7 m/s bring 600, 740 and 744 kg a cycle and over-dig 8.7, 9.2 and 10.0 %,
// as the soil beside the cut breaks out with it.
constexpr double kCurlSpeed = 0.6, kFair = 0.3;
// A bucket that the arm keeps from turning by more than this [rad] comes nearer at this speed [m/s]
// and takes this share of the curl's pace.
constexpr double kStretched = radians(4), kPull = 1.2, kStretchedPace = 0.3;
// Share of the curl at which the bucket has turned.
constexpr double kTurned = 0.7;
/// How a bucket curls: duration [s], the shares of it in which the edge cuts on and from which on
/// it leaves the ground, and the share of a load with which it no longer cuts on.
struct Curl {
  double time, cuts_on, rises, most;
};
// Soil without cohesion runs out of a bucket that leaves the ground half turned, so it turns in its
// cut and rises when it has turned. tuned: on the first slice of the trench in dry sand the usual
// curl brings 711 kg, 2.6 / 0.7 / 0.7 brings 811, 3.4 / 0.8 / 0.7 brings 862, and this one 894 kg.
// Without a limit broken rock overfills it: 1220 kg, where 0.7 of the bucket are aimed at, 895 kg.
constexpr Curl kUsual{1.7, 0.5, 0.4, std::numeric_limits<double>::infinity()},
    kCohesionless{4.2, 0.9, 0.7, 1.25};
// Share of the curl from which on a bucket that has turned may be carried on.
constexpr double kCarryOn = 0.94;
// A curl on the spot pours out soil, so this much of the path to the near end is left to it,
// whatever the load. tuned: on a trench 1.6 m deep, passes along the floor that dragged on to the
// end lost 190 of 250 kg in the curl.
// A pass that cleans up goes on nearer to the end, where the ramps of the scoops are.
constexpr double kCurlPath = 0.6, kCleanCurlPath = 0.4;  // [m]
// The bucket rotates by this share about its pin and by the rest about its edge. About the edge,
// the heel presses on the floor that was just cut and the boom pushes it down. tuned: on the
// trench's first scoop the soil pushes the bucket up by 42, 17 and 2 kN at 0.25, 0.5 and 0.6, and
// the load is 1020, 910 and 940 kg.
constexpr double kAboutPin = 0.65;
constexpr double kOut = 0.15;      // lowest point over the surface after the curl [m]
constexpr double kPastEnd = 0.03;  // the shell may pass the far end by this [m]
// The drag continues by this beyond its planned end when the bucket is not full [m].
constexpr double kMore = 0.5;
// Share of the wanted load with which a scoop ends where it was planned to.
constexpr double kFairLoad = 0.93;
// Raised by this on the way down, the scoop continues at that depth [m].
constexpr double kPenetrateLift = 0.12;
constexpr double kPhaseLimit = 12;  // [s]
// Distance of the heel behind the edge, and below it from which on it decides [m].
constexpr double kHeel = 0.5, kHeelDown = 0.02;
// Length of the bucket's body behind its edge [m], angle between its floor plate and a floor that
// rises behind it, and the largest angles of the edge below and above the horizontal [rad].
constexpr double kBody = 0.7, kFollow = radians(6), kSteepest = radians(65);
constexpr double kTurnedUp = radians(40);

}  // namespace

bool Digging::overdue(double limit) const {
  if (phase_time() <= limit) return false;
  place_.warn(std::string(phase()) + " took more than " + std::to_string(static_cast<int>(limit)) +
              " s, going on with the cycle");
  return true;
}

double Digging::floor_height() const {
  const double below = arm_.below_tip(m.tip.reached),
               floor = plan_.floor_height(m.s, m.scoop_level);
  if (!dig_.is_cut() || below < kHeelDown) return floor + below;
  // The heel is the lowest point, behind the edge, where the floor of a cut may be higher or lower.
  return std::max(floor, plan_.floor_height(m.s + kHeel, m.scoop_level) + below);
}

double Digging::attack() const {
  if (!dig_.is_cut()) return kAttack;
  const double rise =
      plan_.floor_height(m.s + kBody, m.scoop_level) - plan_.floor_height(m.s, m.scoop_level);
  const double slope = std::atan2(rise, kBody);
  // Up a side that rises towards the machine the bucket is turned in, or its load falls out.
  return std::clamp(std::max(slope + kFollow, kAttack + std::min(slope, 0.0)), -kTurnedUp,
                    kSteepest);
}

bool Digging::is_aligned(const Observation& seen) const {
  const vehicle::JointState& swing = seen.joints[place_.joint(0)];
  return std::abs(place_.handover.q[0] - swing.position) < kAside &&
         std::abs(swing.velocity) < kSwingRest;
}

void Digging::follow_tip(const Observation& seen, double dt, Command& out) {
  const TipPath::Part part = phase_index() == kCurl   ? TipPath::Part::kCurl
                             : phase_index() == kDrag ? TipPath::Part::kAlong
                                                      : TipPath::Part::kDown;
  m.tip.follow(place_, m.stance, plan_.point(m.s), seen, dt, part, out);
}

void Digging::penetrate(const Observation& seen, double dt, Command& out) {
  // Fast through air; the last ten centimetres count as soil, and wait for the start of the scoop.
  m.s += std::clamp(m.scoop_start - m.s, -kAlong * dt, kAlong * dt);
  const bool there = std::abs(m.scoop_start - m.s) < kAtStart;
  const double near = m.ground + kNearGround;
  const bool in_air = m.tip.z > near;
  // Between the edges only when the swing has come to rest over the line: a bucket that is still
  // aside takes soil from the wall. One that is down already is not raised again.
  const double over_edge = std::max(near, plan_.start_height(m.s) + kNearGround);
  const double floor = floor_height();
  const bool waits = !is_aligned(seen) && m.tip.z >= over_edge && phase_time() < kSwingPatience;
  const double goal = waits ? over_edge : there ? floor : std::max(near, floor);
  // Braked before the floor, or the boom's mass carries the edge below it.
  const double brake = kDownCreep + std::sqrt(2 * kDownBrake * std::max(0.0, m.tip.z - goal));
  const double down = std::min(in_air ? kDownAir : kDownSoil, brake);
  m.tip.z = std::max(goal, m.tip.z - down * m.tip.slow * dt);
  follow_tip(seen, dt, out);
  // Soil that holds the tip on the way down is dug at the depth it allows.
  if ((there && !waits && m.tip.z <= floor) || m.tip.lift > kPenetrateLift ||
      overdue(kPhaseLimit)) {
    m.lift_before = m.tip.lift;
    m.held_up = 0;
    enter(kDrag);
  }
}

bool Digging::drag(const Observation& seen, double dt, Command& out) {
  // The edge starts to move as fast as the valves open.
  const double pace = m.tip.slow * smooth(phase_time() / kStartTime);
  const double gone = m.s - std::max(0.0, m.s - kDragSpeed * pace * dt);
  m.s -= gone;
  m.held_up += std::max(0.0, m.tip.lift - m.lift_before) * gone;
  // The bucket rotates to its digging angle as soon as its back is clear of the far end.
  const double flat = with_cut(arm_, -kPi + kAttack), floor = with_cut(arm_, -kPi + attack());
  // Turned in up a side, the bucket is not opened again where the side ends.
  const double wish = m.tip.angle < flat ? std::min(floor, m.tip.angle) : floor,
               turned = std::max(wish, m.tip.angle - kTurnIn * pace * dt);
  const double depth = plan_.start_height(m.s) - m.tip.z - m.tip.lift;
  if (plan_.length() - m.s + kPastEnd >= arm_.beyond_tip(turned, depth)) m.tip.angle = turned;
  m.tip.z = std::max(floor_height(), m.tip.z - kDownSoil * m.tip.slow * dt);
  follow_tip(seen, dt, out);
  const double behind = bucket_pose(seen).angle - arm_.forward(place_.arm_angles()).angle;
  const bool turned_in = m.tip.angle + std::max(0.0, behind) <= wish + kTurnedIn;
  // Before it has rotated, its heel is at the far end, and the curl would press it into the wall.
  const bool full = seen.payload >= kCurlAt * aimed_mass() && turned_in;
  // Equal loads leave no small rest of a slice; a dig of a number of cycles fills each.
  const bool fair = !dig_.max_cycles && seen.payload > kFairLoad * aimed_mass();
  // A cut of a job goes on: other strips have taken a part of its soil where they cross.
  const bool more = !dig_.is_cut() && m.s <= m.scoop_end - kMore;
  const bool planned = m.s <= m.scoop_end && (fair || more);
  const double left_to_curl = m.cleaning != 0 ? kCleanCurlPath : kCurlPath;
  const bool at_end = m.s <= std::min(left_to_curl, 0.5 * m.scoop_start);
  if (!(full || planned || at_end || overdue(kPhaseLimit))) return false;
  // The curl begins where the arm is, not where it was commanded to be.
  m.curl_angle = m.tip.angle = m.tip.reached;
  m.curl_z = m.tip.z = m.tip.z + m.tip.lift;
  m.tip.lift = 0;
  m.progress = 0;
  return true;
}

bool Digging::curl(const Observation& seen, double dt, Command& out) {
  // A held bucket still curls, slowly; one that tips the machine waits.
  const double least = m.stance.tilt_factor(seen.X_WB) < 1 ? 0 : 0.1;
  // Far out the stretched arm holds the bucket open: it turns only as its edge comes nearer.
  const bool stretched = m.tip.reached - m.tip.angle > kStretched;
  const double pace = std::max(least, m.tip.slow) * (stretched ? kStretchedPace : 1);
  const Curl& shape = m.cohesionless != 0 ? kCohesionless : kUsual;
  m.progress = std::min(1.0, m.progress + pace * dt / shape.time);
  const bool fair = seen.payload > kFair * m.full_mass || m.s <= kCurlPath;
  const bool cuts_on =
      m.progress < shape.cuts_on && fair && seen.payload < shape.most * m.full_mass;
  const double nearer = std::max(cuts_on ? kCurlSpeed : 0.0, stretched ? kPull : 0.0);
  m.s = std::max(0.0, m.s - nearer * m.tip.slow * dt);
  m.tip.angle = mix(m.curl_angle, kCarry, smooth(m.progress / kTurned));
  const double arc = arm_.bucket_length() * (std::sin(m.tip.reached) - std::sin(m.curl_angle));
  const double turned = std::max(m.curl_z + std::max(0.0, kAboutPin * arc), floor_height());
  // First the bucket rotates; then it leaves the ground straight up.
  // Out of a pit over its rim, as the carry moves outward, where its sides rise.
  const double surface = plan_.start_height(m.s);
  const double clear = dig_.is_cut() ? std::max(surface, dig_.rim) : surface;
  const double top = clear + kOut + arm_.below_tip(m.tip.reached);
  m.tip.z =
      mix(turned, std::max(turned, top), smooth((m.progress - shape.rises) / (1 - shape.rises)));
  const double before = m.tip.reached;
  follow_tip(seen, dt, out);
  // The edge that comes nearer turns about the pin alone, or it would cut on all the way.
  if (stretched)
    m.curl_z += (1 - kAboutPin) * arm_.bucket_length() *
                std::max(0.0, std::sin(m.tip.reached) - std::sin(before));
  // The carry goes on before the bucket has come to rest.
  const bool turned_up = m.progress > kCarryOn && m.tip.reached - kCarry < kTurnedIn;
  return m.progress >= 1 || turned_up || overdue(kPhaseLimit);
}

}  // namespace navvy::control
