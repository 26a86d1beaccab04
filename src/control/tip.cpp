// SPDX-License-Identifier: Apache-2.0
// The steps of a truck beside driving: tip the bed, wait for another machine.
#include <algorithm>
#include <cmath>

#include "control/operator_state.h"
#include "core/log.h"

namespace navvy::control {
namespace {

constexpr double kArrived = radians(1);   // of the bed from its angle
constexpr double kTipPatience = 120;      // [s] for the ram to get there
constexpr double kSlowRate = radians(1);  // [rad/s] slowest bed that is still waited for

}  // namespace

bool Operator::State::run(const scene::Tip& step, const Observation& seen, double dt, Command& out) {
  const auto joint = static_cast<std::size_t>(machine.joint_index(machine.beds.at(0).joint));
  const vehicle::JointState& bed = seen.joints[joint];
  if (m.begun == 0) {
    enter(Phase::kTip);
    m.standing = 0;
    m.way = std::abs(step.angle - bed.position);
    m.begun = 1;
    event = CycleEvent::kTipStart;
  }
  out.joints[joint] = vehicle::JointInput{vehicle::JointMode::kPosition, step.angle};
  const bool late = m.phase_time > std::min(kTipPatience, 10 + m.way / kSlowRate);
  if (late && m.standing == 0)
    log_warning("operator: the bed stopped " + std::to_string(degrees(std::abs(step.angle - bed.position))) +
                " deg short of its angle");
  // `standing` stays positive once the bed has arrived, or was given up.
  if (m.standing > 0 || late || std::abs(step.angle - bed.position) < kArrived) m.standing += dt;
  if (m.standing == 0 || m.standing < step.hold) return false;
  event = CycleEvent::kTipEnd;
  return true;
}

bool Operator::State::run(const scene::WaitFor& step, const Observation& seen, double, Command&) {
  if (m.begun == 0) enter(Phase::kWaitFor);
  m.begun = 1;
  const Progress* other = nullptr;
  if (seen.programs) {
    const auto found = seen.programs->find(step.machine);
    if (found != seen.programs->end()) other = &found->second;
  }
  if (!other) {
    log_warning("operator: nothing known of '" + step.machine + "', going on without it");
    return true;
  }
  if (other->done >= (step.steps > 0 ? step.steps : other->steps)) return true;
  if (m.phase_time < step.longest) return false;
  log_warning("operator: waited " + std::to_string(m.phase_time) + " s for '" + step.machine + "', going on");
  return true;
}

}  // namespace navvy::control
