// SPDX-License-Identifier: Apache-2.0
#include "control/operator.h"

#include <algorithm>
#include <cmath>

#include "control/operator_state.h"
#include "core/log.h"

namespace navvy::control {
namespace {

// Rates of an unhurried operator [rad/s]: swing, boom, stick, bucket; the hydraulics may be slower.
constexpr double kRates[4] = {0.75, 0.40, 0.60, 1.0};
constexpr double kArrived = 0.03;  // [rad]
constexpr double kPatience = 2.0;  // [s] beyond a move's own time

const char* name_of(Phase phase) {
  static const char* const names[] = {"idle", "drive", "return", "approach", "penetrate", "drag",
                                      "curl", "lift",  "swing",  "dump",     "wait",      "trajectory"};
  return names[static_cast<int>(phase)];
}

double smooth(double t) { return t * t * (3 - 2 * t); }

}  // namespace

Operator::State::State(const scene::Machine& machine_in, const scene::Program& program_in)
    : machine(machine_in), program(program_in) {
  for (const scene::ProgramStep& step : program.steps)
    if (std::holds_alternative<scene::Dig>(step) || std::holds_alternative<scene::Swing>(step) ||
        std::holds_alternative<scene::Dump>(step))
      if (!arm) arm.emplace(machine);
}

Operator::Operator(const scene::Machine& machine, const scene::Program& program)
    : state_(std::make_unique<State>(machine, program)) {}
Operator::~Operator() = default;
Operator::Operator(Operator&&) noexcept = default;

bool Operator::done() const { return state_->m.step >= static_cast<int>(state_->program.steps.size()); }
const std::string& Operator::phase() const { return state_->phase_name; }
int Operator::cycles() const { return state_->m.cycles; }
CycleEvent Operator::event() const { return state_->event; }

void Operator::State::enter(Phase next) {
  m.phase = static_cast<int>(next);
  m.phase_time = 0;
  phase_name = name_of(next);
}

Command Operator::update(const Observation& seen, double, double dt) {
  State& s = *state_;
  Command out;
  out.joints.resize(s.machine.joints.size());
  s.event = CycleEvent::kNone;
  if (s.arm) s.read_arm(seen);
  if (!done()) {
    const scene::ProgramStep& step = s.program.steps[static_cast<std::size_t>(s.m.step)];
    if (std::visit([&](const auto& one) { return s.run(one, seen, dt, out); }, step)) {
      ++s.m.step;
      s.m.begun = 0;
      s.enter(Phase::kIdle);
    }
  }
  s.m.phase_time += dt;
  if (s.arm) s.command_arm(out);
  return out;
}

void Operator::State::read_arm(const Observation& seen) {
  if (m.known != 0) return;
  m.q[0] = seen.joints[static_cast<std::size_t>(arm->swing_joint())].position;
  for (std::size_t i = 0; i < 3; ++i) m.q[i + 1] = seen.joints[static_cast<std::size_t>(arm->joints()[i])].position;
  m.known = 1;
}

void Operator::State::command_arm(Command& out) const {
  const auto set = [&](int joint, double q) {
    auto& slot = out.joints[static_cast<std::size_t>(joint)];
    if (!slot) slot = vehicle::JointInput{vehicle::JointMode::kPosition, q};
  };
  set(arm->swing_joint(), m.q[0]);
  for (std::size_t i = 0; i < 3; ++i) set(arm->joints()[i], m.q[i + 1]);
}

void Operator::State::start_move(const std::array<double, 4>& to, const Observation& seen, double share) {
  m.duration = 0.4;
  for (std::size_t i = 0; i < 4; ++i) {
    m.from[i] = m.q[i];
    m.to[i] = to[i];
    const int joint = i == 0 ? arm->swing_joint() : arm->joints()[i - 1];
    const double possible = 0.8 * seen.joints[static_cast<std::size_t>(joint)].velocity_limit;
    const double rate = share * (possible > 0 ? std::min(kRates[i], possible) : kRates[i]);
    // The smooth profile's fastest moment is 1.5 times its mean.
    m.duration = std::max(m.duration, 1.5 * std::abs(m.to[i] - m.from[i]) / rate);
  }
}

bool Operator::State::move(const Observation& seen) {
  const double t = smooth(std::clamp(m.phase_time / m.duration, 0.0, 1.0));
  double error = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    m.q[i] = m.from[i] + t * (m.to[i] - m.from[i]);
    const int joint = i == 0 ? arm->swing_joint() : arm->joints()[i - 1];
    error = std::max(error, std::abs(m.to[i] - seen.joints[static_cast<std::size_t>(joint)].position));
  }
  if (m.phase_time < m.duration) return false;
  if (error < kArrived) return true;
  if (m.phase_time < m.duration + kPatience) return false;
  log_warning("operator: " + phase_name + " ended " + std::to_string(error) + " rad short of its target");
  return true;
}

bool Operator::State::run(const scene::Swing& step, const Observation& seen, double, Command&) {
  if (m.begun == 0) {
    enter(Phase::kSwing);
    start_move({step.angle, m.q[1], m.q[2], m.q[3]}, seen);
    m.begun = 1;
  }
  return move(seen);
}

bool Operator::State::run(const scene::Dump& step, const Observation& seen, double, Command&) {
  if (m.begun == 0) {
    start_dump(seen);
    m.begun = 1;
  }
  return move(seen) && (m.phase_time > m.duration + step.hold);
}

bool Operator::State::run(const scene::Wait& step, const Observation&, double dt, Command&) {
  if (m.begun == 0) enter(Phase::kWait);
  m.begun = 1;
  return m.phase_time + dt >= step.duration;
}

bool Operator::State::run(const scene::Trajectory& step, const Observation&, double, Command& out) {
  if (m.begun == 0) enter(Phase::kTrajectory);
  m.begun = 1;
  const double t = std::clamp(m.phase_time, step.times.front(), step.times.back());
  std::size_t k = 0;
  while (k + 2 < step.times.size() && step.times[k + 1] <= t) ++k;
  const std::size_t n = std::min(k + 1, step.times.size() - 1);
  const double span = step.times[n] - step.times[k];
  const double u = span > 0 ? (t - step.times[k]) / span : 1;
  for (std::size_t i = 0; i < step.joints.size(); ++i) {
    const int joint = machine.joint_index(step.joints[i]);
    const double q = step.positions[k][i] + u * (step.positions[n][i] - step.positions[k][i]);
    out.joints[static_cast<std::size_t>(joint)] = vehicle::JointInput{vehicle::JointMode::kPosition, q};
    if (!arm) continue;
    if (joint == arm->swing_joint()) m.q[0] = q;
    for (std::size_t a = 0; a < 3; ++a)
      if (joint == arm->joints()[a]) m.q[a + 1] = q;
  }
  return m.phase_time >= step.times.back();
}

void Operator::hash(StateHash& hash) const {
  static_assert(std::is_trivially_copyable_v<Memory>);
  const Memory& m = state_->m;
  for (const int v : {m.step, m.phase, m.cycles, m.empty_scoops, m.begun, m.known}) hash.value(v);
  for (int i = 0; i < 4; ++i) hash.value(m.q[i]);
  for (const double v : {m.phase_time, m.duration, m.reach, m.height, m.angle, m.lift, m.slow, m.speed, m.standing})
    hash.value(v);
}

void Operator::save(StateWriter& writer) const {
  writer.begin("operator", 1);
  writer.value(state_->m);
  state_->plan.save(writer);
  writer.end();
}

void Operator::load(StateReader& reader) {
  reader.begin("operator", 1);
  state_->m = reader.value<Memory>();
  state_->plan.load(reader);
  reader.end();
  state_->phase_name = name_of(state_->phase());
}

}  // namespace navvy::control
