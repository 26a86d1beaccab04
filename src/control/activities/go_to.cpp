// SPDX-License-Identifier: Apache-2.0
// The go_to step: plan, steer the wheels, drive a leg, stop; meanwhile monitor the ground along the
// path.
#include "control/activities/go_to.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "control/activity.h"
#include "control/path_follower.h"
#include "control/progress_monitor.h"
#include "control/reach.h"
#include "control/turn_in_place.h"
#include "vehicle/drive/drive_line.h"

namespace navvy::control {
namespace {

// Interval between checks of the ground along the path [s].
constexpr double kLook = 0.25;
// Time at a cusp, and for wheels that have been steered [s].
constexpr double kSettle = 0.3;
// Distance [m] and angle [rad] off the path at which it plans again.
constexpr double kOffPath = 0.25, kOffTurn = radians(20);
// Tolerance from the start of a path that was planned ahead.
constexpr double kElsewhere = 0.1, kElsewhereTurn = radians(3);
// A turn on the spot ends so near to its heading [rad].
constexpr double kTurned = radians(0.5);
// Largest clearance that messages report [m].
constexpr double kRange = 1;
// Number of new plans after a path that ended beside the goal.
constexpr int kMostCorrections = 3;
constexpr int kMostPlans = 100;  // nothing may go on for ever

enum Phase : std::int64_t { kPlan, kTurn, kDrive, kStop, kNoPath, kSpin };

/// The next action once the machine stands.
enum class Then : std::uint8_t { kNextLeg, kPlanAnew, kStartPath };

struct Memory {
  Path path;
  std::int64_t leg = 0;
  double s = 0;         // on the path [m]
  double speed = 0;     // commanded [m/s], without its sign
  double steer = 0;     // bicycle angle commanded last [rad]
  double turn = 0;      // [s] that the wheels need to be turned
  double standing = 0;  // [s]
  double unseen = 0;    // [s] since the last look
  double driven = 0;    // [m] by paths that are left
  double clearance = kRange;
  double heading = 0;  // at the end of a turn on the spot [rad]
  double spin = 0;     // angle of that turn at its start [rad]
  bool spins = true;   // false after a turn that did not get there
  std::int64_t plans = 0, failed = 0, corrections = 0, cusps = 0;
  Then then = Then::kNextLeg;
  ProgressMonitor progress;

  void visit(Archive& a) {
    a("path", path);
    // The path's own number of legs is checked below.
    a("leg", leg);
    a.require(leg >= 0 && leg <= static_cast<std::int64_t>(path.legs().size()), "leg",
              "the path has no such leg");
    a("s", s);
    a("speed", speed);
    a("steer", steer);
    a("turn", turn);
    a("standing", standing);
    a("unseen", unseen);
    a("driven", driven);
    a("clearance", clearance);
    a("heading", heading);
    a("spin", spin);
    a("spins", spins);
    a("plans", plans);
    a("failed", failed);
    a("corrections", corrections);
    a("cusps", cusps);
    a.ranged("then", then, Then::kNextLeg, Then::kStartPath);
    progress.visit(a);
  }
};

class Going final : public ActivityWith<Memory> {
 public:
  Going(OperatorContext& place, const GoTo& step)
      : ActivityWith(place), step_(step), law_(place.machine.drive) {}

  const char* phase() const override {
    switch (phase_index()) {
      case kTurn:
      case kSpin:
        return "turn";
      case kDrive:
        return "drive";
      case kStop:
        return "stop";
      case kNoPath:
        return "no_path";
      default:
        return "plan";
    }
  }

  void begin(const Observation& seen) override {
    place_.handover.is_out = false;
    look(seen);
    const PlanePose at = plane_pose(seen.X_WB);
    // Paths of this step so far were planned when the program began, in an earlier round of a
    // repeat, or for an earlier station of a job, which is another target.
    for (const PlannedPath& ahead : place_.paths)
      if (ahead.step == place_.step && ends_at_goal(ahead.path)) m.path = ahead.path, m.plans = 1;
    // At the goal a turn is enough.
    if (goal_distance(at) <= step_.tolerance && can_turn_to(at, step_.heading))
      m.plans = 0, m.path = Path();
    if (m.plans == 0 || arrived(at)) return;
    const PlanePose& from = m.path.start();
    // `remainder` leaves a turn in -pi to pi, so that whole turns do not count.
    const double aside = (at.p - from.p).norm(),
                 turned = std::abs(std::remainder(at.yaw - from.yaw, 2 * kPi));
    if (!path_is_clear(0))
      place_.note(
          "the ground or a body on its path has changed since its program began: planning again");
    else if (aside > kElsewhere || (turned > kElsewhereTurn && !can_turn_to(at, from.yaw)))
      place_.note("it stands " + metres(aside) + " from where it was to begin: it plans anew");
    else
      follow(at);
  }

  std::vector<Measurement> account(const Observation& seen) const override {
    const PlanePose at = plane_pose(seen.X_WB);
    return {{"plans", static_cast<double>(m.plans)},
            {"cusps", static_cast<double>(m.cusps)},
            {"driven_m", m.driven + m.s},
            {"path_m", m.path.length()},
            {"goal_error_m", goal_distance(at)},
            {"goal_error_deg", degrees(turn_error(at))},
            {"least_clearance_m", m.clearance}};
  }

 private:
  bool update(const Observation& seen, double dt, Command& out) override {
    const PlanePose at = plane_pose(seen.X_WB);
    // Unless it drives, the machine stands: brake on, wheels as they are.
    out.drive = vehicle::DriveInput{0, steer_input(0), true};
    m.standing = seen.v_WB.head<2>().norm() < kStandSpeed ? m.standing + dt : 0;
    switch (phase_index()) {
      case kPlan:
        // A step that begins at its goal ends without driving.
        return arrived(at) ? true : plan(seen, at);
      case kSpin:
        spin(seen, at, dt, out);
        return false;
      case kTurn:
        if (phase_time() >= m.turn) drive_leg(at);
        return false;
      case kDrive:
        return drive(seen, at, dt, out);
      case kStop:
        return m.standing >= kSettle && stand(at);
      default:
        if (phase_time() >= step_.retry) enter(kPlan);
        return false;
    }
  }

  // Goal.
  double goal_distance(const PlanePose& at) const { return (at.p - step_.target).norm(); }
  double turn_error(const PlanePose& at) const {
    return std::abs(std::remainder(at.yaw - step_.heading, 2 * kPi));
  }
  bool arrived(const PlanePose& at) const {
    return goal_distance(at) <= step_.tolerance && turn_error(at) <= step_.turn_tolerance;
  }

  // Ground.
  void look(const Observation& seen) {
    m.unseen = 0;
    place_.look(seen);
    m.clearance = std::min(m.clearance, place_.planner->clearance(plane_pose(seen.X_WB), kRange));
  }
  bool path_is_clear(double s) const {
    return keeps_clearance(*place_.planner, m.path, s, step_.clearance);
  }

  /// Plans from the machine's present pose; returns true when the step is over.
  bool plan(const Observation& seen, const PlanePose& at) {
    look(seen);
    if (m.plans >= kMostPlans)
      return fall_short(StepState::kOutOfTime, "not there after " + std::to_string(kMostPlans) +
                                                   " plans, " + metres(goal_distance(at)) +
                                                   " from the target");
    if (goal_distance(at) <= step_.tolerance && can_turn_to(at, step_.heading)) {
      m.spins = ++m.corrections <= kMostCorrections;
      if (m.spins) {
        begin_spin(at, step_.heading, Then::kPlanAnew);
        return false;
      }
    }
    // Each search has another seed: where one has found nothing, the next may.
    const PathQuery query = step_.query(at, static_cast<int>(m.plans + m.failed));
    const std::optional<Path> path =
        m.spins ? plan_path(*place_.planner, place_.machine, query) : place_.planner->plan(query);
    if (path) {
      ++m.plans;
      m.failed = 0;
      m.path = *path;
      place_.paths.push_back({place_.step, place_.now, *path});
      follow(at);
      return false;
    }
    ++m.failed;
    // The planner cannot say why; the clearances at both ends show the usual causes.
    const std::string why = no_path(at);
    if (m.failed >= step_.tries) return fall_short(StepState::kNoPath, why);
    place_.warn(why + "; it tries again in " + number_text(step_.retry, "s"));
    enter(kNoPath);
    return false;
  }

  std::string no_path(const PlanePose& at) const {
    std::string out = "no path from " + place_text(at.p) + " to " + place_text(step_.target) +
                      " that keeps " + metres(step_.clearance) +
                      " from ground it cannot drive on and from bodies: ";
    const double here = place_.planner->clearance(at, step_.clearance);
    const double there = place_.planner->clearance({step_.target, step_.heading}, step_.clearance);
    // A machine near an obstacle may leave it, but one that stands on it finds no path.
    if (here <= 0 && step_.clearance > 0)
      out += "it stands on some";
    else if (there < step_.clearance)
      out += "the goal lies " + metres(there) + " from some";
    else
      out += std::to_string(step_.iterations) + " iterations found none";
    return out + (m.failed > 1
                      ? ", try " + std::to_string(m.failed) + " of " + std::to_string(step_.tries)
                      : "");
  }

  // Turn on the spot.
  bool spins() const { return m.spins && turns_in_place(place_.machine); }
  bool can_turn_to(const PlanePose& at, double heading) const {
    return spins() && can_turn(*place_.planner, at, heading, step_.clearance);
  }
  bool ends_at_goal(const Path& path) const {
    const PlanePose end = path.at(path.length());
    return spins() ? goal_distance(end) <= step_.tolerance : arrived(end);
  }
  /// Drives the path, after a turn to its first heading.
  void follow(const PlanePose& at) {
    const double heading = m.path.start().yaw;
    if (spins() && std::abs(std::remainder(heading - at.yaw, 2 * kPi)) > kTurned)
      begin_spin(at, heading, Then::kStartPath);
    else
      start_path(at);
  }
  void begin_spin(const PlanePose& at, double heading, Then then) {
    m.heading = heading;
    m.spin = std::remainder(heading - at.yaw, 2 * kPi);
    m.then = then;
    enter(kSpin);
  }
  void spin(const Observation& seen, const PlanePose& at, double dt, Command& out) {
    double left = std::remainder(m.heading - at.yaw, 2 * kPi);
    // After about half a turn the other way round is shorter, but not known to be clear.
    if (left * m.spin < 0 && std::abs(left) > 0.5 * kPi) left += std::copysign(2 * kPi, m.spin);
    m.unseen += dt;
    if (m.unseen >= kLook && std::abs(left) < kPi) {
      look(seen);
      if (!can_turn_to(at, m.heading)) {
        place_.note("the ground or a body beside it has changed: planning again");
        return stop(Then::kPlanAnew);
      }
    }
    if (std::abs(left) <= kTurned) return stop(m.then);
    if (phase_time() < longest_turn(m.spin)) {
      out.drive = turn_command(left);
      return;
    }
    place_.note("it does not turn on the spot: it plans a path");
    m.spins = false;
    stop(Then::kPlanAnew);
  }

  // Path.
  void start_path(const PlanePose& at) {
    m.leg = 0;
    m.s = m.speed = 0;
    begin_leg(at);
  }
  const PathLeg& leg() const { return m.path.legs()[static_cast<std::size_t>(m.leg)]; }
  bool past_last() const { return m.leg >= static_cast<std::int64_t>(m.path.legs().size()); }

  /// Steers the wheels to the start of the leg while the machine stands; there may be no leg.
  void begin_leg(const PlanePose& at) {
    const double angle = past_last() ? 0 : law_.steer_at_start(m.path, leg());
    // A differential drive has no wheels to steer.
    m.turn = std::abs(angle - m.steer) / law_.steer_rate() + kSettle;
    m.steer = angle;
    m.progress.begin(at);
    enter(kTurn);
  }
  void drive_leg(const PlanePose& at) {
    m.speed = 0;
    m.progress.begin(at);
    enter(past_last() ? kStop : kDrive);
  }

  bool drive(const Observation& seen, const PlanePose& at, double dt, Command& out) {
    const PathPlace place = law_.place(m.path, leg(), at, m.s);
    m.s = place.s;
    const double left = leg().end - m.s;
    if (left < kStopShort) {
      // A cusp, or the end.
      stop(Then::kNextLeg);
      return false;
    }
    m.unseen += dt;
    if (m.unseen >= kLook) {
      look(seen);
      if (!path_is_clear(m.s)) {
        place_.note("the ground or a body on its path has changed: planning again");
        stop(Then::kPlanAnew);
        return false;
      }
    }
    if (std::abs(place.aside) > kOffPath || std::abs(place.turned) > kOffTurn) {
      place_.note("it is " + metres(std::abs(place.aside)) + " off its path: it plans anew");
      stop(Then::kPlanAnew);
      return false;
    }
    std::string held;
    const StepState progress = m.progress.look(seen, place_.machine, step_.speed, goal_distance(at),
                                               m.path.length() - m.s, dt, held);
    if (progress != StepState::kRunning) return fall_short(progress, held);
    // 30 s of allowance for short legs, and three times the duration at full speed.
    if (phase_time() > 30 + 3 * (leg().end - leg().begin) / step_.speed)
      return fall_short(StepState::kOutOfTime, "a leg of " + metres(leg().end - leg().begin) +
                                                   " took longer than " +
                                                   number_text(phase_time(), "s"));
    // Accelerate along the ramp, decelerate along the curves that end in a bend's speed or at the
    // leg's end.
    m.speed = std::min(
        {step_.speed, m.speed + kDriveAcceleration * dt, law_.speed_limit(m.path, leg(), m.s)});
    m.steer = law_.steer(m.path, leg(), place);
    const double speed = leg().sense * m.speed;
    out.drive = vehicle::DriveInput{speed, steer_input(speed), false};
    return false;
  }

  void stop(Then then) {
    m.then = then;
    m.standing = 0;
    enter(kStop);
  }

  /// Handles a machine that has come to a stop; returns true when the step is over.
  bool stand(const PlanePose& at) {
    if (m.then == Then::kStartPath) {
      start_path(at);
      return false;
    }
    const bool anew = m.then == Then::kPlanAnew;
    // A leg that was broken off has not been driven.
    if (!anew) ++m.leg;
    if (!anew && !past_last()) {
      ++m.cusps;
      begin_leg(at);
      return false;
    }
    // The distance on this path is added before another path begins at 0.
    m.driven += std::exchange(m.s, 0);
    enter(kPlan);
    if (anew || arrived(at)) return !anew;
    // The next plan is a turn on the spot.
    if (goal_distance(at) <= step_.tolerance && can_turn_to(at, step_.heading)) return false;
    if (++m.corrections > kMostCorrections)
      return fall_short(StepState::kOutOfReach, "it stands " + metres(goal_distance(at)) + " and " +
                                                    number_text(degrees(turn_error(at)), "deg") +
                                                    " from the goal after " +
                                                    std::to_string(m.plans) + " plans");
    place_.note("it stands " + metres(goal_distance(at)) + " and " +
                number_text(degrees(turn_error(at)), "deg") + " from the goal: it plans anew");
    return false;
  }

  double steer_input(double speed) const {
    return vehicle::steer_command(place_.machine.drive, m.steer, speed);
  }

  const GoTo& step_;
  const PathFollower law_;
};

}  // namespace

void GoTo::check(const scene::StepSource& source) const {
  source.require(source.machine && source.machine->has_drive,
                 "go_to needs a machine with <navvy:drive>");
  source.on_site("target_m", target);
}

PathQuery GoTo::query(const PlanePose& from, int plan) const {
  return {from, {target, heading}, clearance, iterations, static_cast<std::uint32_t>(seed + plan)};
}

std::unique_ptr<Activity> GoTo::activity(OperatorContext& place) const {
  return std::make_unique<Going>(place, *this);
}

void GoTo::check_reach(ReachCheck& check) const {
  if (!check.planner) {
    check.fault("go_to", "", "nobody plans paths here",
                "build with -DNAVVY_WITH_OMPL=ON (Debian package libompl-dev), or use drive_to");
    return;
  }
  const double there = check.planner->clearance({target, heading}, clearance);
  if (there >= clearance) return;
  const std::string rule = "the machine would stand " + metres(there) +
                           " from ground that it cannot drive on, or from a body, as they are at "
                           "the start; needed are " +
                           metres(clearance);
  const std::string remedy =
      "choose another goal or a smaller <clearance_m>; navvy map --layers traversability shows "
      "them";
  if (check.after_digging())
    check.warn("go_to/target", place_text(target), rule, remedy);
  else
    check.fault("go_to/target", place_text(target), rule, remedy);
}

std::optional<Pose> GoTo::station(const scene::Machine&, const Pose& X_WB,
                                  const SurfaceView& surface) const {
  const Vec3 from = X_WB.translation();
  // The base link keeps its height over the ground; slopes are left to the run.
  const double rise = from.z() - surface.height(from.x(), from.y());
  return make_pose(target.x(), target.y(), surface.height(target.x(), target.y()) + rise, 0, 0,
                   heading);
}

}  // namespace navvy::control
