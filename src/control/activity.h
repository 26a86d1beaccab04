// SPDX-License-Identifier: Apache-2.0
// Base class of the activities that carry out program steps, and the data that the steps of one
// operator share.
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
/// Returns a swing angle together with the angles of boom, stick and bucket [rad].
inline Axes with_arm(double swing, const ArmAngles& q) { return {swing, q[0], q[1], q[2]}; }

/// Values that one step passes on to the next.
struct Handover {
  /// Digging cycles of the program so far.
  std::int64_t cycles = 0;
  /// 1 once `q` has been read from the machine.
  std::int64_t known = 0;
  /// Commanded angles of the arm [rad]; moves start here, not at the machine's measured angles.
  Axes q{};

  void visit(Archive& a) {
    a("cycles", cycles);
    a("known", known);
    a("q", q);
  }
};

/// One operator's machine and the data that its steps share. Activities keep a reference to it.
struct OperatorContext {
  /// Copies the machine. The owner adds the arm and the planner where the program needs them.
  explicit OperatorContext(const scene::Machine& machine_in) : machine(machine_in) {}

  /// The machine; its joints are in the order of Observation and Command.
  const scene::Machine machine;
  /// Planner of paths; set in every program with a step that needs one.
  std::unique_ptr<PathPlanner> planner;
  /// Paths of all steps, in the order in which they were planned.
  std::vector<PlannedPath> paths;
  /// Kinematics of the arm; set in every program with a step that needs it.
  std::optional<ArmKinematics> arm;
  Handover handover;
  /// Name of the operator in messages, such as "'truck', step 2 (tip)". Derived, not part of the
  /// state.
  std::string label = "operator";
  /// Number of the running step, 1-based. Derived, not part of the state.
  std::int64_t step = 1;
  /// Simulated time of this control step [s]. Derived, not part of the state.
  double now = 0;

  /// Warns the user that something did not go as commanded; the step continues.
  void warn(const std::string& text) const { log_warning(label + ": " + text); }
  /// Logs an event that is as expected.
  void note(const std::string& text) const { log_info(label + ": " + text); }
  /// Gives the planner the ground as it is seen now.
  void look(const Observation& seen) const {
    if (seen.surface != nullptr)
      planner->look(*seen.surface);
    else if (seen.ground != nullptr)
      planner->look(GroundSurfaceView(*seen.ground));
  }

  /// Returns the index in Machine::joints of axis 0 to 3: swing, boom, stick, bucket.
  std::size_t joint(std::size_t axis) const {
    return static_cast<std::size_t>(axis == 0 ? arm->swing_joint() : arm->joints()[axis - 1]);
  }
  /// Returns the commanded angles of boom, stick and bucket [rad].
  ArmAngles arm_angles() const { return {handover.q[1], handover.q[2], handover.q[3]}; }
};

/// Carries out one step: `begin` is called once, then `advance` every control step until it returns
/// true, then the activity is destroyed.
///
/// Deterministic: a function of its state, the context and the observations. Every phase has a time
/// limit, after which the step continues or falls short and says so, so an activity never hangs. A
/// snapshot taken at any moment resumes bit-identically.
class Activity {
 public:
  explicit Activity(OperatorContext& place) : place_(place) {}
  virtual ~Activity() = default;
  Activity(const Activity&) = delete;
  Activity& operator=(const Activity&) = delete;

  /// Sets the activity up right before its first `advance`. Not called after a snapshot was loaded.
  virtual void begin(const Observation& seen) = 0;
  /// Advances by one control step of `dt` [s]. Returns true when the step is over; this call was
  /// then the last.
  bool advance(const Observation& seen, double dt, Command& out) {
    const bool over = update(seen, dt, out);
    clock_.time += dt;
    if (over && state_ == StepState::kRunning) state_ = StepState::kDone;
    return over;
  }
  /// Returns the name of the current phase for telemetry and messages: one word.
  virtual const char* phase() const = 0;
  /// Returns the event reported since the last call of this function, and clears it.
  CycleEvent take_event() { return std::exchange(event_, CycleEvent::kNone); }

  /// Returns kRunning while the step runs; then kDone, or how it fell short.
  StepState state() const { return state_; }
  /// Returns the reason as a sentence without time and place, which the operator adds. Empty when
  /// there is nothing to say.
  const std::string& reason() const { return reason_; }
  /// Returns the step's own measurements so far. They are asked for when the step ends, however it
  /// ends, and whenever a summary is written, so they must not depend on how often they are asked
  /// for.
  virtual std::vector<Measurement> account(const Observation&) const { return {}; }

  /// Visits the state from `begin` on; events are not part of it. Snapshots are taken between calls
  /// of `advance`. An override calls this function first.
  virtual void visit(Archive& a) {
    a("phase", clock_.phase);
    a("phase_time", clock_.time);
    // The state is kRunning between calls: an activity that is over is thrown away.
    a("remark", reason_);
  }

  // For derived classes: what they do, and what they have to do it with.
 protected:
  /// Advances by one control step: reads `seen`, commands through `out` and
  /// OperatorContext::handover. Returns true when the step is over.
  virtual bool update(const Observation& seen, double dt, Command& out) = 0;

  /// Enters a phase and restarts its clock. Activities with several phases pass a value of their
  /// own enum.
  void enter(std::int64_t phase) { clock_ = {phase, 0}; }
  /// Returns the phase last entered; 0 at first.
  std::int64_t phase_index() const { return clock_.phase; }
  /// Returns the time since the phase was entered, at the start of this control step [s].
  double phase_time() const { return clock_.time; }
  /// Reports an event once with the result of this control step. A later event in the same step
  /// replaces it.
  void tell(CycleEvent event) { event_ = event; }
  /// Ends the step, and the program with it, short of its aim: `return
  /// fall_short(StepState::kBlocked, "...")`. Always returns true.
  bool fall_short(StepState state, std::string reason) {
    state_ = state;
    reason_ = std::move(reason);
    return true;
  }
  /// Attaches a remark to a step that is done all the same. A later remark replaces it.
  void remark(std::string text) { reason_ = std::move(text); }

  OperatorContext& place_;

 private:
  // Part of every activity's state, so that derived classes need not save it.
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
