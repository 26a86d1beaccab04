// SPDX-License-Identifier: Apache-2.0
#include "control/operator.h"

#include <algorithm>
#include <cmath>

#include "control/operator_state.h"
#include "core/log.h"

namespace navvy::control {
namespace {

// Rates of an unhurried operator at the middle of a move [rad/s]: swing, boom, stick, bucket; hydraulics may be slower.
constexpr double kRates[4] = {0.80, 0.45, 0.70, 1.5};
constexpr double kShareOfLimit = 0.85;           // of a joint's own speed limit
constexpr double kShortestMove = 0.4;            // [s]
constexpr double kArrived = 0.03;                // [rad]
constexpr double kSettle = 0.3, kAtRest = 0.02;  // past a move's time at rest is as good as arrived [s], [rad/s]
constexpr double kPatience = 2.0;                // beyond a move's own time [s]

const char* name_of(Phase phase) {
  static const char* const names[] = {"idle",  "drive", "return", "approach", "penetrate",  "drag", "curl",    "lift",
                                      "swing", "dump",  "look",   "wait",     "trajectory", "tip",  "wait_for"};
  return names[static_cast<int>(phase)];
}

double smooth(double t) {
  const double c = std::clamp(t, 0.0, 1.0);
  return c * c * (3 - 2 * c);
}

void check_bed(const scene::Machine& machine) {
  const std::string joint = machine.beds.empty() ? "" : machine.beds[0].joint;
  if (machine.joint_index(joint) < 0)
    throw InputError(Fault{Fault::Severity::kError, machine.file, 0, machine.name + "/navvy:program/tip", joint,
                           "tip needs a machine with a bed on a joint of its own", "add <navvy:bed>"});
}

/// A trajectory as the loader would let it pass; programs built in C++ may be anything.
void check_trajectory(const scene::Machine& machine, const scene::Trajectory& step) {
  const auto fail = [&](const std::string& value, const std::string& rule) {
    throw InputError(Fault{Fault::Severity::kError, machine.file, 0, machine.name + "/navvy:program/trajectory", value,
                           rule, "give every joint one position for each time"});
  };
  if (step.times.empty()) fail("", "a trajectory needs at least one time");
  if (step.positions.size() != step.times.size())
    fail(std::to_string(step.positions.size()) + " rows", "needs one row of positions for each time");
  for (const auto& row : step.positions)
    if (row.size() != step.joints.size()) fail(std::to_string(row.size()), "a row needs one position for each joint");
  for (const std::string& name : step.joints)
    if (machine.joint_index(name) < 0) fail(name, "no joint of this name in the machine");
}

}  // namespace

Operator::State::State(const scene::Machine& machine_in, const scene::Program& program_in)
    : machine(machine_in), program(program_in) {
  for (const scene::ProgramStep& step : program.steps)
    if (std::holds_alternative<scene::Dig>(step) || std::holds_alternative<scene::Swing>(step) ||
        std::holds_alternative<scene::Dump>(step))
      if (!arm) arm.emplace(machine);
  for (const scene::ProgramStep& step : program.steps)
    if (const auto* trajectory = std::get_if<scene::Trajectory>(&step)) check_trajectory(machine, *trajectory);
  for (const scene::ProgramStep& step : program.steps)
    if (std::holds_alternative<scene::Tip>(step)) check_bed(machine);
}

Operator::Operator(const scene::Machine& machine, const scene::Program& program)
    : state_(std::make_unique<State>(machine, program)) {}
Operator::~Operator() = default;
Operator::Operator(Operator&&) noexcept = default;

bool Operator::done() const { return state_->m.step >= static_cast<int>(state_->program.steps.size()); }
const std::string& Operator::phase() const { return state_->phase_name; }
int Operator::cycles() const { return state_->m.cycles; }
Progress Operator::progress() const { return {state_->m.step, static_cast<int>(state_->program.steps.size())}; }
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

std::size_t Operator::State::axis_joint(std::size_t axis) const {
  return static_cast<std::size_t>(axis == 0 ? arm->swing_joint() : arm->joints()[axis - 1]);
}

std::array<double, 4> Operator::State::with_arm(double swing, const ArmAngles& q) const {
  return {swing, q[0], q[1], q[2]};
}

void Operator::State::read_arm(const Observation& seen) {
  if (m.known != 0) return;
  for (std::size_t i = 0; i < 4; ++i) m.q[i] = seen.joints[axis_joint(i)].position;
  m.known = 1;
}

void Operator::State::command_arm(Command& out) const {
  for (std::size_t i = 0; i < 4; ++i)
    if (auto& slot = out.joints[axis_joint(i)]; !slot)
      slot = vehicle::JointInput{vehicle::JointMode::kPosition, m.q[i]};
}

void Operator::State::start_move(const std::array<double, 4>& to, const Observation& seen, Pace pace) {
  double time[4];
  for (std::size_t i = 0; i < 4; ++i) {
    m.from[i] = m.q[i];
    m.to[i] = to[i];
    const double possible = kShareOfLimit * seen.joints[axis_joint(i)].velocity_limit;
    const double rate = possible > 0 ? std::min(pace.share * kRates[i], possible) : pace.share * kRates[i];
    // The smooth profile's fastest moment is 1.5 times its mean.
    time[i] = std::max(kShortestMove, 1.5 * std::abs(m.to[i] - m.from[i]) / rate);
  }
  // Boom, stick and bucket share one time: what is level at both ends stays level on the way.
  m.swing_time = time[0];
  m.arm_time = std::max({time[1], time[2], time[3]});
  m.arm_delay = time[0] > kShortestMove ? pace.arm_delay * time[0] : 0;
}

double Operator::State::move_time() const { return std::max(m.swing_time, m.arm_delay + m.arm_time); }

bool Operator::State::move(const Observation& seen) {
  const double swing = smooth(m.phase_time / m.swing_time), other = smooth((m.phase_time - m.arm_delay) / m.arm_time);
  double error = 0, speed = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    m.q[i] = m.from[i] + (i == 0 ? swing : other) * (m.to[i] - m.from[i]);
    const vehicle::JointState& joint = seen.joints[axis_joint(i)];
    error = std::max(error, std::abs(m.to[i] - joint.position));
    speed = std::max(speed, std::abs(joint.velocity));
  }
  const double over = m.phase_time - move_time();
  if (over < 0) return false;
  if (error < kArrived || (over > kSettle && speed < kAtRest)) return true;
  if (over < kPatience) return false;
  log_warning("operator: " + phase_name + " ended " + std::to_string(error) + " rad short of its target");
  return true;
}

bool Operator::State::run(const scene::Swing& step, const Observation& seen, double, Command&) {
  if (m.begun == 0) {
    enter(Phase::kSwing);
    start_move({step.angle, m.q[1], m.q[2], m.q[3]}, seen, {});
    m.begun = 1;
  }
  return move(seen);
}

bool Operator::State::run(const scene::Dump& step, const Observation& seen, double, Command&) {
  if (m.begun == 0) {
    m.bucket_before = m.q[3];
    m.closing = 0;
    start_dump(seen);
    m.begun = 1;
  }
  if (m.closing == 0) {
    if (m.phase_time <= move_time()) move(seen);
    if (m.phase_time <= move_time() + step.hold) return false;
    m.closing = 1;
    start_move({m.q[0], m.q[1], m.q[2], m.bucket_before}, seen, {});
    enter(Phase::kDump);
    return false;
  }
  return move(seen);
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
  hash.bytes(&state_->m, sizeof(Memory));
  state_->plan.hash(hash);
}

void Operator::save(StateWriter& writer) const {
  writer.begin("operator", 2);
  writer.value(state_->m);
  state_->plan.save(writer);
  writer.end();
}

void Operator::load(StateReader& reader) {
  reader.begin("operator", 2);
  // The scene may have changed since.
  state_->m = reader.value<Memory>();
  state_->plan.load(reader);
  reader.end();
  state_->phase_name = name_of(state_->phase());
}

}  // namespace navvy::control
