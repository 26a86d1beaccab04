// SPDX-License-Identifier: Apache-2.0
#include "control/operator.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "control/activity.h"
#include "control/activity_step.h"
#include "control/reach.h"
#include "control/turn_in_place.h"
#include "control/watch.h"

namespace navvy::control {

struct Operator::State {
  State(const scene::Machine& machine, const scene::Program& program_in, const std::string& name_in,
        const Planners& planners);

  // Activities refer to the steps and to the context: all three keep their addresses, as the state
  // does not move.
  const scene::Program program;
  const std::string name;
  std::vector<const ActivityStep*> steps;
  OperatorContext place;
  std::unique_ptr<Activity> active;  // of steps[step], null between steps
  std::int64_t step = 0;
  Watch watch;
  double started = 0;                   // the running step [s]
  Vec3 stood = Vec3::Zero();            // place of the base when the running step began [m]
  std::vector<StepReport> reports;      // of the steps that are over
  std::vector<std::uint8_t> commanded;  // by joint: the program has
  double steer = 0;                     // of the last command to the drive
  CycleEvent event = CycleEvent::kNone;

  bool past_last() const { return step >= static_cast<std::int64_t>(steps.size()); }
  bool done() const { return past_last() && !failed(); }
  /// Returns true after a failure that no step has caught: then the step that failed is the present
  /// one, or all steps are over.
  bool failed() const { return fell_short_last() && (past_last() || reports.back().step > step); }
  bool fell_short_last() const { return !reports.empty() && fell_short(reports.back().state); }
  const ActivityStep& present() const { return *steps[static_cast<std::size_t>(step)]; }
  void make_activity();
  void plan_ahead(const Observation& seen);
  StepState look(const Observation& seen, double dt, std::string& reason);
  void watch_over(const Observation& seen, double time, double dt);
  void finish(StepState state, const std::string& reason, const Observation& seen, double time);
  StepReport report(StepState state, const std::string& reason, const Observation& seen,
                    double time) const;
  void go_on_after(StepState state);
  void read_arm(const Observation& seen);
  void hold_arm(Command& out) const;
  Command stop() const;
  void note(const Command& out);
};

Operator::State::State(const scene::Machine& machine, const scene::Program& program_in,
                       const std::string& name_in, const Planners& planners)
    : program(program_in),
      name(name_in.empty() ? machine.name : name_in),
      place(machine),
      commanded(machine.joints.size()) {
  for (const scene::ProgramStep& one : program.steps) steps.push_back(&step_of(one));
  // One step that uses the arm makes all hold it: left alone, it would sink or be shaken while the
  // machine drives.
  const auto needs_arm = [](const ActivityStep* one) { return one->needs_arm(); };
  if (std::any_of(steps.begin(), steps.end(), needs_arm)) place.arm.emplace(place.machine);
  for (const ActivityStep* one : steps) {
    if (one->needs_job_planner() && !place.jobs) {
      if (!planners.jobs)
        throw InputError(Fault{Fault::Severity::kError, machine.file, 0,
                               name + "/navvy:program/" + one->element(), "",
                               "nobody plans jobs here",
                               "hand a job planner to the operator, or dig single trenches"});
      place.jobs = planners.jobs(place.machine);
    }
    if (!one->needs_planner() || place.planner) continue;
    if (!planners.paths)
      throw InputError(
          Fault{Fault::Severity::kError, machine.file, 0, name + "/navvy:program/" + one->element(),
                "", "nobody plans paths here", "hand a planner to the operator, or use drive_to"});
    place.planner = planners.paths(place.machine);
  }
  const auto repeats = [](const ActivityStep* one) { return one->repeats() > 0; };
  if (std::any_of(steps.begin(), steps.end(), repeats)) place.rounds.resize(steps.size());
  // Reported before anything moves, not when the step's turn comes.
  for (const ActivityStep* one : steps) one->check_machine(place.machine);
}

void Operator::State::make_activity() {
  place.label =
      "'" + name + "', step " + std::to_string(step + 1) + " (" + present().element() + ")";
  // The step creates its activity, whose state is new every time.
  place.step = step + 1;
  place.fell_short = fell_short_last();
  active = present().activity(place);
}

/// Plans the paths of all steps on the ground at the program's start, up to the first step after
/// which it is not known where the machine stands.
void Operator::State::plan_ahead(const Observation& seen) {
  if (!place.planner) return;
  place.look(seen);
  const GroundSurfaceView resting(*seen.ground);
  const SurfaceView& surface = seen.surface != nullptr ? *seen.surface : resting;
  Pose X_WB = seen.X_WB;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (const std::optional<PathQuery> query = steps[i]->path_ahead(plane_pose(X_WB))) {
      if (std::optional<Path> path = plan_path(*place.planner, place.machine, *query))
        place.paths.push_back({static_cast<std::int64_t>(i) + 1, place.now, *std::move(path)});
      else
        log_warning(
            "'" + name + "', step " + std::to_string(i + 1) + " (" + steps[i]->element() +
            "): no path on the ground as it lies when the program begins; it will look again then");
    }
    // A job ends wherever its last station is.
    if (steps[i]->needs_job_planner()) return;
    if (const std::optional<Pose> next = steps[i]->station(place.machine, X_WB, surface))
      X_WB = *next;
  }
}

StepReport Operator::State::report(StepState state, const std::string& reason,
                                   const Observation& seen, double time) const {
  // A step that has not begun has no account.
  StepReport out{step + 1, present().element(),     state, reason, active ? started : time,
                 time,     seen.X_WB.translation(), {}};
  if (active) out.measurements = active->account(seen);
  return out;
}

void Operator::State::finish(StepState state, const std::string& reason, const Observation& seen,
                             double time) {
  reports.push_back(report(state, reason, seen, time));
  const bool back = active && active->goes_back();
  const int skipped = active ? active->skips() : 0;
  active.reset();
  if (fell_short(state)) return go_on_after(state);
  if (back) {
    // At most to the first step, also in a program that nobody checked.
    ++place.rounds[static_cast<std::size_t>(step)];
    step = std::max<std::int64_t>(0, step - present().repeats());
    return;
  }
  // Rounds count anew when a repeat is reached again from before.
  if (!place.rounds.empty()) place.rounds[static_cast<std::size_t>(step)] = 0;
  step = std::min<std::int64_t>(step + 1 + skipped, static_cast<std::int64_t>(steps.size()));
}

/// Goes on at the next step that catches a failure. If there is none, or if the machine can do
/// nothing more, the step that fell short stays the present one: the program goes no further.
void Operator::State::go_on_after(StepState state) {
  if (past_last() || state == StepState::kTipped || state == StepState::kBuried ||
      state == StepState::kOffSite)
    return;
  const auto from = steps.begin() + step + 1;
  const auto to =
      std::find_if(from, steps.end(), [](const ActivityStep* one) { return one->catches(); });
  if (to == steps.end()) return;
  place.warn(std::string(name_of(state)) + ", the program goes on at step " +
             std::to_string(to - steps.begin() + 1) + ": " + reports.back().reason);
  for (const std::int64_t next = to - steps.begin(); step < next; ++step)
    if (!place.rounds.empty()) place.rounds[static_cast<std::size_t>(step)] = 0;
  // The arm may be held: what follows begins where it is.
  place.handover.known = 0;
}

namespace {

/// Returns true for steps in which the machine keeps its place. A dig moves its machine and has
/// limits of its own, and a trajectory may turn wheels.
bool stands_still(const ActivityStep& step) {
  const std::string element = step.element();
  return element == "wait" || element == "wait_for" || element == "swing" || element == "dump" ||
         element == "tip" || element == "unhitch";
}

}  // namespace

/// Returns the state in which the machine must stop, with its reason, or kRunning.
StepState Operator::State::look(const Observation& seen, double dt, std::string& reason) {
  if (const StepState state = watch.look(seen, dt, reason); fell_short(state)) return state;
  const Vec3 p = seen.X_WB.translation();
  if (seen.ground != nullptr && is_off_site(*seen.ground, p)) {
    reason = "its base is beyond the border of the site";
    return StepState::kOffSite;
  }
  const double moved = (p - stood).head<2>().norm();
  const bool towed = seen.is_coupled && seen.is_coupled();
  if (!active || !stands_still(present()) || !(moved > kMostMoved) || towed)
    return StepState::kRunning;
  reason = "it slid or was pushed " + metres(moved) + " while it was to keep its place";
  return StepState::kMoved;
}

/// A machine can tip over long after its program is done: a second report of the last step says so.
void Operator::State::watch_over(const Observation& seen, double time, double dt) {
  std::string reason;
  const StepState state = look(seen, dt, reason);
  if (!fell_short(state) || reports.empty()) return;
  reports.push_back({static_cast<std::int64_t>(steps.size()),
                     reports.back().element,
                     state,
                     "after its program was done: " + reason,
                     time,
                     time,
                     seen.X_WB.translation(),
                     {}});
}

void Operator::State::read_arm(const Observation& seen) {
  // Only once: from then on commands follow commands, so that a load that bends the arm does not
  // make it drift.
  if (place.handover.known != 0) return;
  // Swing, boom, stick, bucket.
  for (std::size_t i = 0; i < 4; ++i) place.handover.q[i] = seen.joints[place.joint(i)].position;
  place.handover.known = 1;
}

void Operator::State::hold_arm(Command& out) const {
  // Commands of the activity itself stay.
  for (std::size_t i = 0; i < 4; ++i)
    if (auto& slot = out.joints[place.joint(i)]; !slot)
      slot = vehicle::JointInput{vehicle::JointMode::kPosition, place.handover.q[i]};
}

Command Operator::State::stop() const {
  Command out;
  out.joints.resize(commanded.size());
  // Hold the joints where they are, not at their targets, because the motion there may be what went
  // wrong. Other joints keep their commands.
  for (std::size_t j = 0; j < commanded.size(); ++j)
    if (commanded[j] != 0) out.joints[j] = vehicle::JointInput{vehicle::JointMode::kVelocity, 0};
  if (place.machine.has_drive) out.drive = vehicle::DriveInput{0, steer, true};
  return out;
}

void Operator::State::note(const Command& out) {
  for (std::size_t j = 0; j < commanded.size(); ++j)
    if (out.joints[j]) commanded[j] = 1;
  if (out.drive) steer = out.drive->steer;
}

Operator::Operator(const scene::Machine& machine, const scene::Program& program, std::string name,
                   const Planners& planners)
    : state_(std::make_unique<State>(machine, program, name, planners)) {}
Operator::~Operator() = default;
Operator::Operator(Operator&&) noexcept = default;
Operator& Operator::operator=(Operator&&) noexcept = default;

bool Operator::done() const { return state_->done(); }
bool Operator::ended() const { return state_->done() || state_->failed(); }
Command Operator::stop() const { return state_->stop(); }
// The step and its activity know everything else; this function only keeps the order.
std::string Operator::phase() const {
  if (state_->failed()) return name_of(state_->reports.back().state);
  return state_->active ? state_->active->phase() : "idle";
}
ProgramProgress Operator::progress() const {
  return {static_cast<int>(state_->step), static_cast<int>(state_->steps.size()), state_->failed()};
}
CycleEvent Operator::event() const { return state_->event; }
const std::vector<StepReport>& Operator::reports() const { return state_->reports; }
const std::vector<PlannedPath>& Operator::paths() const { return state_->place.paths; }

StepReport Operator::present(const Observation& seen, double time) const {
  const State& s = *state_;
  if (!ended())
    return s.report(StepState::kRunning, s.active ? s.active->reason() : "", seen, time);
  return s.reports.empty() ? StepReport{} : s.reports.back();
}

Command Operator::update(const Observation& seen, double time, double dt) {
  State& s = *state_;
  Command out;
  out.joints.resize(s.place.machine.joints.size());
  s.event = CycleEvent::kNone;
  if (s.failed()) return out;
  if (s.place.arm) s.read_arm(seen);
  s.place.now = time;
  if (!s.done()) {
    if (!s.active) {
      // Once: steps that run again plan when their turn comes.
      if (s.step == 0 && s.reports.empty()) s.plan_ahead(seen);
      s.make_activity();
      s.started = time;
      s.stood = seen.X_WB.translation();
      s.active->begin(seen);
    }
    std::string reason;
    if (const StepState state = s.look(seen, dt, reason); fell_short(state)) {
      s.finish(state, reason, seen, time);
    } else {
      const bool over = s.active->advance(seen, dt, out);
      s.event = s.active->take_event();
      // The next step begins with the next control step, so telemetry sees "idle" between them.
      if (over) s.finish(s.active->state(), s.active->reason(), seen, time);
    }
  } else {
    s.watch_over(seen, time, dt);
  }
  // Also before a step that catches the failure.
  if (!s.active && s.fell_short_last()) {
    s.note(out);
    return s.stop();
  }
  if (s.place.arm) s.hold_arm(out);
  s.note(out);
  return out;
}

void Operator::visit(Archive& a) {
  State& s = *state_;
  // Version 5: reports of the steps, commands; 6: the machine's stability; 7: events after the last
  // step; 8: a scoop begins before its soil; 9: the place where a step began; 10: stations of a job
  // that were not reached; 11: surplus of a last pass into a bed.
  a.section("operator", 11, [&] {
    a("step", s.step);
    a.require(s.step >= 0 && s.step <= static_cast<std::int64_t>(s.steps.size()), "step",
              "the program has no such step; use the scene it was made with");
    a("handover", s.place.handover);
    a("watch", s.watch);
    a("started", s.started);
    a.unhashed("follows from the states before; states of equal runs keep their hashes",
               [&] { a("stood", s.stood); });
    a("reports", s.reports);
    // One per completed step; one more for the step that fell short, or for an event after the last
    // step.
    const std::int64_t over = s.step + (s.failed() ? 1 : 0);
    // Steps that run again have a report for each round.
    const auto count = static_cast<std::int64_t>(s.reports.size());
    // Of steps that are left out there is none.
    const bool leaves_out = std::any_of(s.steps.begin(), s.steps.end(),
                                        [](const ActivityStep* one) { return one->catches(); });
    a.require(leaves_out || (s.place.rounds.empty() ? count == over : count >= over), "reports",
              "another number of them than steps that are over");
    // Only programs with a repeat have any.
    if (!s.place.rounds.empty()) a.fixed("rounds", s.place.rounds);
    // As many as the scene's machine has joints.
    a.fixed("commanded", s.commanded);
    a("steer", s.steer);
    // Only programs that ask for paths have any.
    if (s.place.planner) a("paths", s.place.paths);
    // The running step's name, so that a snapshot of another program is refused instead of misread.
    // Between steps there is no activity, and nothing of the last one is left.
    std::string running;
    if (!a.loading() && s.active) running = s.present().element();
    a("running", running);
    a.require(running.empty() || !s.failed(), "running", "the program has ended");
    if (a.loading()) {
      // The scene may have changed since.
      const std::string here = s.past_last() ? "" : s.present().element();
      a.require(
          running.empty() || running == here, "running",
          "the program has another step there: '" + here + "'; use the scene it was made with");
      // Created anew, then it loads its state.
      s.active.reset();
      if (!running.empty()) s.make_activity();
    }
    if (s.active) a("activity", *s.active);
  });
}

}  // namespace navvy::control
