// SPDX-License-Identifier: Apache-2.0
// What carries out one step of a program, and what the steps of one operator share.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "control/arm_kinematics.h"
#include "control/observation.h"
#include "control/outcome.h"
#include "control/path_planner.h"
#include "core/archive.h"
#include "core/log.h"
#include "scene/machine.h"

namespace navvy::control {

/// Angles of swing, boom, stick and bucket [rad].
using Axes = std::array<double, 4>;
/// A swing angle with the angles of boom, stick and bucket.
inline Axes with_arm(double swing, const ArmAngles& q) { return {swing, q[0], q[1], q[2]}; }

/// What one step hands on to the next.
struct Handover {
  std::int64_t cycles = 0;  ///< digging cycles of the program so far
  std::int64_t known = 0;   ///< 1 once `q` was read from the machine
  /// Commanded angles of the arm; moves begin here, not where the machine is.
  Axes q{};

  void visit(Archive& a) {
    a("cycles", cycles);
    a("known", known);
    a("q", q);
  }
};

/// One operator's machine, and what flows from step to step. Activities keep a reference to it.
struct OperatorContext {
  /// Copies the machine. Whoever builds the workplace adds the arm where the program needs it.
  explicit OperatorContext(const scene::Machine& machine_in) : machine(machine_in) {}

  const scene::Machine machine;  ///< its joints in the order of Observation and Command
  /// In every program with a step that needs one.
  std::unique_ptr<PathPlanner> planner;
  std::vector<PlannedPath> paths;    ///< of all steps, in the order in which they were planned
  std::optional<ArmKinematics> arm;  ///< in every program with a step that needs one
  Handover handover;
  /// Who speaks in messages: "'truck', step 2 (tip)"; derived, no state.
  std::string label = "operator";
  std::int64_t step = 1;  ///< number of the running step; derived
  double now = 0;         ///< of this control step, simulated [s]; derived

  /// Tells the user what does not go as asked, and that the step goes on.
  void warn(const std::string& text) const { log_warning(label + ": " + text); }
  /// The same of what is as it should be.
  void note(const std::string& text) const { log_info(label + ": " + text); }
  /// Shows the planner the ground as it is seen.
  void look(const Observation& seen) const {
    if (seen.surface != nullptr)
      planner->look(*seen.surface);
    else if (seen.ground != nullptr)
      planner->look(GroundSurfaceView(*seen.ground));
  }

  /// Index in Machine::joints of axis 0..3: swing, boom, stick, bucket.
  std::size_t joint(std::size_t axis) const {
    return static_cast<std::size_t>(axis == 0 ? arm->swing_joint() : arm->joints()[axis - 1]);
  }
  /// Commanded angles without the swing [rad].
  ArmAngles arm_angles() const { return {handover.q[1], handover.q[2], handover.q[3]}; }
};

/// Carries out one step: begun once, then asked every control step until it is over, then thrown
/// away.
///
/// Deterministic: a function of its memory, the workplace and the observations. Never hangs: every
/// phase has a time limit, after which the step goes on or falls short, and says so. A snapshot
/// taken at any moment resumes bit for bit.
class Activity {
 public:
  explicit Activity(OperatorContext& place) : place_(place) {}
  virtual ~Activity() = default;
  Activity(const Activity&) = delete;
  Activity& operator=(const Activity&) = delete;

  /// Sets the activity up, right before its first `advance`; not called after `load`.
  virtual void begin(const Observation& seen) = 0;
  /// One control step of `dt` [s]. True: the step is over, and this call was the last.
  bool advance(const Observation& seen, double dt, Command& out) {
    const bool over = update(seen, dt, out);
    clock_.time += dt;
    if (over && state_ == StepState::kRunning) state_ = StepState::kDone;
    return over;
  }
  /// What it is doing, for telemetry and messages: one word.
  virtual const char* phase() const = 0;
  /// The event told since the last call of this.
  CycleEvent take_event() { return std::exchange(event_, CycleEvent::kNone); }

  /// Once it is over: kDone, or how it fell short; before, kRunning. The reason is a sentence
  /// without time and place, which the operator adds; empty when there is nothing to say.
  StepState state() const { return state_; }
  const std::string& reason() const { return reason_; }
  /// The step's own account as far as it has come, in figures: asked when the step ends, however it
  /// ends, and whenever a summary is written. Must not depend on how often it is asked.
  virtual std::vector<Measurement> account(const Observation&) const { return {}; }

  /// State from `begin` on; events are not part of it. Snapshots are taken between calls of
  /// `advance`. Who overrides it calls this first.
  virtual void visit(Archive& a) {
    a("phase", clock_.phase);
    a("phase_time", clock_.time);
    // The state is kRunning between calls: an activity that is over is thrown away.
    a("remark", reason_);
  }

  // For derived classes: what they do, and what they have to do it with.
 protected:
  /// One control step: looks at `seen`, commands through `out` and Workplace::handover. True when
  /// the step is over.
  virtual bool update(const Observation& seen, double dt, Command& out) = 0;

  /// Goes to a phase: its time begins anew. Activities with several give their own enum here.
  void enter(std::int64_t phase) { clock_ = {phase, 0}; }
  /// The phase last entered; 0 at first.
  std::int64_t phase_index() const { return clock_.phase; }
  /// Since the phase was entered, at the start of this control step [s].
  double phase_time() const { return clock_.time; }
  /// Reported once with the result of this control step; a later one in the same step replaces it.
  void tell(CycleEvent event) { event_ = event; }
  /// The step ends short of its aim, and its program with it: `return
  /// fall_short(StepState::kBlocked, "...")`.
  bool fall_short(StepState state, std::string reason) {
    state_ = state;
    reason_ = std::move(reason);
    return true;
  }
  /// Said of a step that is done all the same; a later one replaces it.
  void remark(std::string text) { reason_ = std::move(text); }

  OperatorContext& place_;

 private:
  // Part of every activity's state, so that no kind has to think of it.
  struct Clock {
    std::int64_t phase = 0;
    double time = 0;  // [s]
  };
  Clock clock_;
  CycleEvent event_ = CycleEvent::kNone;
  StepState state_ = StepState::kRunning;
  std::string reason_;
};

/// An activity whose state is one struct `m`, which lists its fields in a `visit(Archive&)`. An
/// activity with state besides (the plan of a dig) overrides visit and calls this one first.
template <class Memory>
class ActivityWith : public Activity {
 public:
  using Activity::Activity;
  void visit(Archive& a) override {
    Activity::visit(a);
    m.visit(a);
  }

 protected:
  Memory m;
};

}  // namespace navvy::control
