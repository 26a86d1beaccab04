// SPDX-License-Identifier: Apache-2.0
// The drive_to step: speed ramp, pursuit, brake.
#include "control/activities/drive_to.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "control/activity.h"
#include "control/curvature_feedback.h"
#include "control/progress_monitor.h"
#include "control/reach.h"
#include "vehicle/drive/drive_line.h"

namespace navvy::control {
namespace {

// Wheelbases by which a machine backs off the target before its second approach, if it came from so
// far: twice the length of an S bend that shifts it by its miss.
constexpr double kBackOff = 4;
// Times that a machine may approach its target.
constexpr int kApproaches = 2;

enum Phase : std::int64_t { kDrive, kBackOffPhase };

struct Memory {
  double speed = 0;     // commanded [m/s], without its sign
  double heading = 0;   // of the line that is followed [rad]
  double standing = 0;  // [s] with the brake on and at rest; positive once it brakes
  /// Distance to the target at the start [m].
  double start_distance = 0;
  /// Number of ended approaches, and the distance from the target at which the first one ended [m].
  std::int64_t approaches = 0;
  double first_miss = 0;
  ProgressMonitor progress;
  CurvatureFeedback feedback;

  void visit(Archive& a) {
    a("speed", speed);
    a("heading", heading);
    a("standing", standing);
    a("start_distance", start_distance);
    a("approaches", approaches);
    a("first_miss", first_miss);
    progress.visit(a);
    feedback.visit(a);
  }
};

class Driving final : public ActivityWith<Memory> {
 public:
  Driving(OperatorContext& place, const DriveTo& step)
      : ActivityWith(place),
        step_(step),
        bicycle_(vehicle::equivalent_bicycle(place.machine.drive)) {}
  const char* phase() const override {
    return phase_index() == kBackOffPhase ? "back_off" : "drive";
  }

  void begin(const Observation& seen) override {
    place_.handover.is_out = false;
    const PlanePose at = plane_pose(seen.X_WB);
    m.heading = Pursuit::of(step_, place_.machine.drive, at).heading;
    // The time limit depends on the whole distance, not on what is left.
    m.start_distance = (step_.target - at.p).norm();
    begin_leg(at);
  }

 private:
  bool update(const Observation& seen, double dt, Command& out) override {
    const PlanePose at = plane_pose(seen.X_WB);
    const Pursuit pursuit = leg(at);
    const double limit = 30 + 3 * m.start_distance / std::max(0.05, std::abs(step_.speed));
    const bool late = phase_time() > limit;
    if (pursuit.left(at) < kStopShort || m.standing > 0 || late) {
      brake(seen, dt, out);
      if (m.standing < kStandTime && phase_time() < limit + 10) return false;
      return stand(at, late);
    }
    std::string held;
    const StepState progress = m.progress.look(seen, place_.machine, step_.speed, miss(at),
                                               remaining(pursuit, at), dt, held);
    if (progress != StepState::kRunning) {
      // A machine that is held short of its target but within the tolerance has arrived.
      if (phase_index() != kDrive || miss(at) > step_.tolerance) return fall_short(progress, held);
      remark(held + "; allowed are " + metres(step_.tolerance));
      brake(seen, dt, out);
      return false;
    }
    // Accelerate along the ramp, decelerate along the curve that stops at the target.
    m.speed = std::min(
        {std::abs(step_.speed), m.speed + kDriveAcceleration * dt, pursuit.speed_limit(at)});
    const double speed = pursuit.sense() * m.speed;
    // Pursuit steers by a bicycle angle; the drive converts it.
    const CurvatureFeedback::Steering steering = m.feedback.correct(
        bicycle_, at, pursuit.steer(at), speed, forward_speed(at, seen.v_WB), dt);
    out.drive = vehicle::DriveInput{
        steering.ease * speed, vehicle::steer_command(place_.machine.drive, steering.angle, speed),
        false};
    return false;
  }

  /// Brakes; `standing`, the time at rest with the brake on, stays positive from then on.
  void brake(const Observation& seen, double dt, Command& out) {
    out.drive = vehicle::DriveInput{0, 0, true};
    m.standing =
        seen.v_WB.head<2>().norm() < kStandSpeed ? m.standing + dt : std::max(m.standing, 1e-9);
  }

  /// Returns the distance from the target [m].
  double miss(const PlanePose& at) const { return (step_.target - at.p).norm(); }

  /// Returns a length that decreases while the machine turns to its line, approaches it and
  /// advances along it [m].
  double remaining(const Pursuit& pursuit, const PlanePose& at) const {
    const Vec2 across(-std::sin(m.heading), std::cos(m.heading));
    return std::max(0.0, pursuit.left(at)) + std::abs((at.p - pursuit.target).dot(across)) +
           bicycle_.wheelbase * std::abs(std::remainder(at.yaw - m.heading, 2 * kPi));
  }

  /// Returns the law of the present leg: to the target, or away from it along the same line.
  Pursuit leg(const PlanePose& at) const {
    Pursuit out = Pursuit::of(step_, place_.machine.drive, at);
    // Without a heading, the line is the one seen at the start, not from here.
    out.heading = m.heading;
    if (phase_index() != kBackOffPhase) return out;
    const double back = std::min(kBackOff * bicycle_.wheelbase, m.start_distance);
    out.target -= out.sense() * back * Vec2(std::cos(m.heading), std::sin(m.heading));
    out.speed = -out.speed;
    return out;
  }

  void begin_leg(const PlanePose& at) {
    m.speed = m.standing = 0;
    m.progress.begin(at);
    m.feedback.begin(at);
  }

  /// Handles a machine that has come to a stop; returns true when the step is over.
  bool stand(const PlanePose& at, bool late) {
    const bool arrived = phase_index() != kBackOffPhase && miss(at) <= step_.tolerance;
    if (late && !arrived)
      return fall_short(StepState::kOutOfTime, "not there after " + number_text(phase_time(), "s") +
                                                   ", " + metres(miss(at)) + " from the target");
    if (phase_index() == kBackOffPhase) {
      enter(kDrive);
      begin_leg(at);
      return false;
    }
    if (miss(at) <= step_.tolerance) {
      if (m.approaches > 0)
        remark("its first approach ended " + metres(m.first_miss) +
               " from the target; it backed off and came again");
      return true;
    }
    if (m.approaches == 0) m.first_miss = miss(at);
    if (++m.approaches >= kApproaches)
      return fall_short(StepState::kOutOfReach,
                        "it stands " + metres(miss(at)) + " from the target after " +
                            std::to_string(m.approaches) + " approaches; allowed are " +
                            metres(step_.tolerance));
    enter(kBackOffPhase);
    begin_leg(at);
    return false;
  }

  const DriveTo& step_;
  const scene::AckermannDrive bicycle_;
};

}  // namespace

void DriveTo::check(const scene::StepSource& source) const {
  if (source.has("speed_m_per_s") && speed == 0)
    source.error("speed_m_per_s", "0", "the speed must not be zero");
  source.require(source.machine && source.machine->has_drive,
                 "drive_to needs a machine with <navvy:drive>");
  source.on_site("target_m", target);
}

std::unique_ptr<Activity> DriveTo::activity(OperatorContext& place) const {
  return std::make_unique<Driving>(place, *this);
}

void DriveTo::check_reach(ReachCheck& check) const {
  const PlanePose start = plane_pose(check.X_WB);
  const scene::Drive& drive = check.machine.drive;
  // The law of the run on a machine that rolls without slip: reports what steering alone cannot
  // reach.
  const PlanePose end = Pursuit::of(*this, drive, start)
                            .end_from(start, vehicle::equivalent_bicycle(drive).steer_rate);
  const double distance = (end.p - target).norm();
  if (distance > tolerance)
    check.fault("drive_to", place_text(target),
                "steering as far as it can the machine ends at " + place_text(end.p) + ", " +
                    metres(distance) + " from the target; allowed are " + metres(tolerance),
                "give it a longer distance to turn in, or approach in two drives");
}

std::optional<Pose> DriveTo::station(const scene::Machine& machine, const Pose& X_WB,
                                     const SurfaceView& surface) const {
  const Vec3 from = X_WB.translation();
  // The base link keeps its height over the ground; slopes are left to the run.
  const double rise = from.z() - surface.height(from.x(), from.y());
  const double yaw = Pursuit::of(*this, machine.drive, plane_pose(X_WB)).heading;
  return make_pose(target.x(), target.y(), surface.height(target.x(), target.y()) + rise, 0, 0,
                   yaw);
}

}  // namespace navvy::control
