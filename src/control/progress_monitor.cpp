// SPDX-License-Identifier: Apache-2.0
#include "control/progress_monitor.h"

#include <algorithm>
#include <cmath>

#include "control/reach.h"

namespace navvy::control {
namespace {

// A machine that moves by less than this within its patience makes no progress. The patience is
// that of a driver who sees nothing happen, longer for drives so slow that they need it.
constexpr double kMoved = 0.05, kTurned = radians(2);  // [m], [rad]
constexpr double kPatience = 5;                        // [s]
// Patience with a machine that moves but does not advance: long enough for a turn on the spot.
constexpr double kLongPatience = 20;  // [s]
// Tyres or tracks that push sideways with this share of the weight push against an obstacle: on any
// slope, without other contacts, their forces add up to the opposite of the weight, which is
// vertical.
constexpr double kPush = 0.03;

}  // namespace

void ProgressMonitor::begin(const PlanePose& at) {
  anchor(at);
  least_ = -1;
  idle_ = 0;
}

void ProgressMonitor::anchor(const PlanePose& at) {
  anchor_ = Vec3(at.p.x(), at.p.y(), at.yaw);
  stuck_ = rolled_ = 0;
  push_.setZero();
}

StepState ProgressMonitor::look(const Observation& seen, const scene::Machine& machine,
                                double speed, double left, double remaining, double dt,
                                std::string& reason) {
  const PlanePose at = plane_pose(seen.X_WB);
  const bool moved = (at.p - anchor_.head<2>()).norm() > kMoved ||
                     std::abs(std::remainder(at.yaw - anchor_.z(), 2 * kPi)) > kTurned;
  if (moved) anchor(at);
  idle_ += dt;
  if (least_ < 0 || remaining < least_ - kMoved) {
    least_ = std::max(0.0, remaining);
    idle_ = 0;
  }
  if (idle_ >= std::max(kLongPatience, 16 * kMoved / std::abs(speed))) {
    reason = "it has moved for " + number_text(idle_, "s") + " without advancing on its path, " +
             metres(left) + " from the target";
    return StepState::kStalled;
  }
  stuck_ += dt;
  push_ += dt * seen.tyre_force;
  // Use the fastest driven wheel: an open differential may turn one side alone.
  double fastest = 0;
  for (const scene::Wheel& wheel : machine.wheels) {
    const int joint = wheel.driven ? machine.joint_index(wheel.joint) : -1;
    if (joint >= 0)
      fastest = std::max(
          fastest, wheel.radius * std::abs(seen.joints[static_cast<std::size_t>(joint)].velocity));
  }
  rolled_ += dt * fastest;
  if (stuck_ < std::max(kPatience, 4 * kMoved / std::abs(speed))) return StepState::kRunning;
  const double push = push_.head<2>().norm() / stuck_;
  const std::string stood =
      "it has stood for " + number_text(stuck_, "s") + ", " + metres(left) + " from the target";
  if (push > kPush * machine.total_mass() * kGravity) {
    reason = stood + ": something holds it while its drive pushes with " +
             number_text(push / 1000, "kN");
    return StepState::kBlocked;
  }
  reason = stood + (rolled_ > kMoved ? ": its wheels have spun for " + metres(rolled_)
                                     : ": the drive does not turn its wheels");
  return StepState::kStalled;
}

}  // namespace navvy::control
