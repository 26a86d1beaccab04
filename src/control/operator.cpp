// SPDX-License-Identifier: Apache-2.0
#include "control/operator.h"

#include <algorithm>
#include <vector>

#include "control/activity.h"
#include "control/step.h"

namespace navvy::control {

struct Operator::State {
  State(const scene::Machine& machine, const scene::Program& program_in);

  // Activities refer to the steps and to the workplace: all three keep their addresses, as the state does not move.
  const scene::Program program;
  std::vector<const Step*> steps;
  Workplace place;
  std::unique_ptr<Activity> active;  // of steps[step], null between steps
  std::int64_t step = 0;
  CycleEvent event = CycleEvent::kNone;

  bool done() const { return step >= static_cast<std::int64_t>(steps.size()); }
  const Step& present() const { return *steps[static_cast<std::size_t>(step)]; }
  void read_arm(const Observation& seen);
  void hold_arm(Command& out) const;
};

Operator::State::State(const scene::Machine& machine, const scene::Program& program_in)
    : program(program_in), place(machine) {
  for (const scene::ProgramStep& one : program.steps) steps.push_back(&step_of(one));
  // One step that uses the arm makes all hold it: left alone it would sink or be shaken while the machine drives.
  const auto needs_arm = [](const Step* one) { return one->needs_arm(); };
  if (std::any_of(steps.begin(), steps.end(), needs_arm)) place.arm.emplace(place.machine);
  // Told before anything moves, not when the step's turn comes.
  for (const Step* one : steps) one->check_machine(place.machine);
}

void Operator::State::read_arm(const Observation& seen) {
  // Once only: from then on commands follow commands, so that a load that bends the arm does not make it drift.
  if (place.handover.known != 0) return;
  // Swing, boom, stick, bucket.
  for (std::size_t i = 0; i < 4; ++i) place.handover.q[i] = seen.joints[place.joint(i)].position;
  place.handover.known = 1;
}

void Operator::State::hold_arm(Command& out) const {
  // What the activity has commanded itself stays.
  for (std::size_t i = 0; i < 4; ++i)
    if (auto& slot = out.joints[place.joint(i)]; !slot)
      slot = vehicle::JointInput{vehicle::JointMode::kPosition, place.handover.q[i]};
}

Operator::Operator(const scene::Machine& machine, const scene::Program& program)
    : state_(std::make_unique<State>(machine, program)) {}
Operator::~Operator() = default;
Operator::Operator(Operator&&) noexcept = default;

bool Operator::done() const { return state_->done(); }
// All else is known to the step and its activity; here is only the order.
std::string Operator::phase() const { return state_->active ? state_->active->phase() : "idle"; }
int Operator::cycles() const { return static_cast<int>(state_->place.handover.cycles); }
ProgramProgress Operator::progress() const {
  return {static_cast<int>(state_->step), static_cast<int>(state_->steps.size())};
}
CycleEvent Operator::event() const { return state_->event; }

Command Operator::update(const Observation& seen, double, double dt) {
  State& s = *state_;
  Command out;
  out.joints.resize(s.place.machine.joints.size());
  s.event = CycleEvent::kNone;
  if (s.place.arm) s.read_arm(seen);
  if (!s.done()) {
    // The description makes what carries it out; its memory is new every time.
    if (!s.active) {
      s.active = s.present().activity(s.place);
      s.active->begin(seen);
    }
    const bool over = s.active->advance(seen, dt, out);
    s.event = s.active->take_event();
    // The next step begins with the next control step: telemetry sees "idle" between them.
    if (over) {
      s.active.reset();
      ++s.step;
    }
  }
  if (s.place.arm) s.hold_arm(out);
  return out;
}

void Operator::visit(Archive& a) {
  State& s = *state_;
  a.section("operator", 4, [&] {
    a("step", s.step);
    a.require(s.step >= 0 && s.step <= static_cast<std::int64_t>(s.steps.size()), "step",
              "the program has no such step; use the scene it was made with");
    a("handover", s.place.handover);
    // The running step's name, so that a snapshot of another program is refused instead of misread. Between steps there
    // is no activity, and nothing of the last one is left.
    std::string running;
    if (!a.loading() && s.active) running = s.present().element();
    a("running", running);
    if (a.loading()) {
      // The scene may have changed since.
      const std::string here = s.done() ? "" : s.present().element();
      a.require(running.empty() || running == here, "running",
                "the program has another step there: '" + here + "'; use the scene it was made with");
      // Made anew, then it reads its memory.
      s.active = running.empty() ? nullptr : s.present().activity(s.place);
    }
    if (s.active) a("activity", *s.active);
  });
}

}  // namespace navvy::control
