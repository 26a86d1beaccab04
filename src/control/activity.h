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
#include "control/job_planner.h"
#include "control/observation.h"
#include "control/outcome.h"
#include "control/path_planner.h"
#include "core/archive.h"
#include "core/log.h"
#include "scene/machine.h"

namespace navvy::control {

/// Angles of the arm's four joints: swing, boom, stick and bucket, in this order [rad].
using Axes = std::array<double, 4>;
/// Returns the axes made of a swing angle and the angles of boom, stick and bucket [rad].
inline Axes with_arm(double swing, const ArmAngles& q) { return {swing, q[0], q[1], q[2]}; }

/// Values that one step of a program passes on to the next.
struct Handover {
  /// Number of digging cycles that the program has completed so far.
  std::int64_t cycles = 0;
  /// 1 if `q` has been initialised from the machine's joint angles, else 0.
  std::int64_t known = 0;
  /// Commanded angles of the arm [rad]. A move of the arm starts from these, not from the measured
  /// angles, so that the arm does not drift under load.
  Axes q{};
  /// Position of the swing joint at which the last load was dug [rad].
  double dug_at = 0;
  /// True from then until the bucket returns, or another step moves swing or machine.
  bool is_out = false;

  /// Saves or loads all fields.
  void visit(Archive& a) {
    a("cycles", cycles);
    a("known", known);
    a("q", q);
    a("dug_at", dug_at);
    a("is_out", is_out);
  }
};

/// The machine of one operator, and the data that the steps of its program share. Activities keep a
/// reference to it.
struct OperatorContext {
  /// Copies the machine. The operator sets `arm` and `planner` afterwards if the program needs
  /// them.
  explicit OperatorContext(const scene::Machine& machine_in) : machine(machine_in) {}

  /// Description of the machine. Observation and Command list the joints in the same order.
  const scene::Machine machine;
  /// Path planner; null if no step of the program plans paths.
  std::unique_ptr<PathPlanner> planner;
  /// Job planner; null if no step of the program plans a job.
  std::unique_ptr<JobPlanner> jobs;
  /// Paths of all steps, in the order in which they were planned.
  std::vector<PlannedPath> paths;
  /// Kinematics of the arm; empty if no step of the program uses the arm.
  std::optional<ArmKinematics> arm;
  /// Values passed on from step to step, such as the commanded angles of the arm.
  Handover handover;
  /// Prefix of messages: machine and step, such as "'truck', step 2 (tip)". Set for each step and
  /// not saved in snapshots.
  std::string label = "operator";
  /// Position of the running step in the program, counted from 1. Not saved in snapshots.
  std::int64_t step = 1;
  /// Number of times that each step of the program has gone back; empty if no step does.
  std::vector<std::int64_t> rounds;
  /// True if the step before the running one fell short. Follows from the reports of the steps.
  bool fell_short = false;
  /// Simulated time of the current control step [s]. Not saved in snapshots.
  double now = 0;

  /// Logs a warning: something did not go as commanded, but the step continues.
  void warn(const std::string& text) const { log_warning(label + ": " + text); }
  /// Logs an expected event for information.
  void note(const std::string& text) const { log_info(label + ": " + text); }
  /// Updates the planner's map from the currently visible ground. Requires `planner`.
  void look(const Observation& seen) const {
    if (seen.surface != nullptr)
      planner->look(*seen.surface);
    else if (seen.ground != nullptr)
      planner->look(GroundSurfaceView(*seen.ground));
  }

  /// Returns the index in Machine::joints of axis 0 to 3: swing, boom, stick, bucket. Requires
  /// `arm`.
  std::size_t joint(std::size_t axis) const {
    return static_cast<std::size_t>(axis == 0 ? arm->swing_joint() : arm->joints()[axis - 1]);
  }
  /// Returns the commanded angles of boom, stick and bucket [rad].
  ArmAngles arm_angles() const { return {handover.q[1], handover.q[2], handover.q[3]}; }
};

/// Carries out one step of a program. The operator calls `begin` once and then `advance` in every
/// control step until that returns true; then it destroys the activity.
///
/// The commands depend only on the activity's state, the context and the observations, so runs
/// repeat exactly. Every phase has a time limit, after which the step continues or fails with a
/// reason, so an activity never waits forever. A run resumed from a snapshot continues
/// bit-identically.
class Activity {
 public:
  /// Makes an activity for the machine in `place`. Stores a reference to `place`, which must
  /// outlive the activity.
  explicit Activity(OperatorContext& place) : place_(place) {}
  virtual ~Activity() = default;
  Activity(const Activity&) = delete;
  Activity& operator=(const Activity&) = delete;

  /// Initialises the activity. Called once, right before the first `advance`; not called after a
  /// snapshot has been loaded.
  virtual void begin(const Observation& seen) = 0;
  /// Advances the activity by one control step of `dt` [s] and adds its commands to `out`. Returns
  /// true when the step is over; `advance` must not be called again then.
  bool advance(const Observation& seen, double dt, Command& out) {
    const bool over = update(seen, dt, out);
    clock_.time += dt;
    if (over && state_ == StepState::kRunning) state_ = StepState::kDone;
    return over;
  }
  /// Returns the name of the current phase, one word, for telemetry and messages.
  virtual const char* phase() const = 0;
  /// Returns the event reported since the last call of this function, or kNone, and clears it.
  CycleEvent take_event() { return std::exchange(event_, CycleEvent::kNone); }

  /// Returns kRunning while the step runs; afterwards kDone, or the state in which it failed.
  StepState state() const { return state_; }
  /// Returns true if the step has ended and the steps before it are to run again
  /// (ActivityStep::repeats).
  bool goes_back() const { return back_; }
  /// Returns the number of steps after this one that are left out when it has ended.
  int skips() const { return skips_; }
  /// Returns the explanation of the state as a sentence, to which the operator adds time and
  /// position. Empty if there is nothing to explain.
  const std::string& reason() const { return reason_; }
  /// Returns the step's own measurements so far. This function is called when the step ends for any
  /// reason, and whenever a summary is written. The measurements must not depend on the number of
  /// calls.
  virtual std::vector<Measurement> account(const Observation&) const { return {}; }

  /// Saves or loads the state after `begin`. Snapshots are taken between calls of `advance`;
  /// pending events are not saved. An override must call this function first.
  virtual void visit(Archive& a) {
    a("phase", clock_.phase);
    a("phase_time", clock_.time);
    // The state is kRunning between calls: an activity that is over is thrown away.
    a("remark", reason_);
  }

  // Interface for derived classes.
 protected:
  /// Advances the activity by one control step of `dt` [s]: reads `seen`, and writes commands to
  /// `out` and to OperatorContext::handover. Returns true when the step is over.
  virtual bool update(const Observation& seen, double dt, Command& out) = 0;

  /// Enters a phase and restarts the phase clock. `phase` is a value of the derived class's own
  /// enum.
  void enter(std::int64_t phase) { clock_ = {phase, 0}; }
  /// Returns the value last passed to `enter`; 0 before the first call.
  std::int64_t phase_index() const { return clock_.phase; }
  /// Returns the time from the entry into the current phase to the start of this control step [s].
  double phase_time() const { return clock_.time; }
  /// Reports an event to the operator in this control step. A second event in the same control step
  /// replaces the first.
  void tell(CycleEvent event) { event_ = event; }
  /// Marks the step as failed with a state and a reason, for the operator to act on. Always returns
  /// true, so that an activity can end with `return fall_short(StepState::kBlocked, "...")`.
  bool fall_short(StepState state, std::string reason) {
    state_ = state;
    reason_ = std::move(reason);
    return true;
  }
  /// Makes the steps before this one run again when this control step ends the step.
  void go_back() { back_ = true; }
  /// Leaves out so many steps after this one when this control step ends the step.
  void skip(int steps) { skips_ = steps; }
  /// Sets the remark that is reported with a step that succeeds. A later remark replaces it.
  void remark(std::string text) { reason_ = std::move(text); }

  /// Machine and shared data of the operator.
  OperatorContext& place_;

 private:
  // Phase clock. The base class saves it, so that derived classes need not.
  struct Clock {
    // Current phase: the value last passed to `enter`.
    std::int64_t phase = 0;
    // Time since the phase was entered [s].
    double time = 0;
  };
  // Current phase and the time spent in it.
  Clock clock_;
  // True if steps are to run again; set in the last control step, so it is not saved.
  bool back_ = false;
  // Number of steps to leave out; as `back_`.
  int skips_ = 0;
  // Event that has been reported but not yet taken; kNone if there is none.
  CycleEvent event_ = CycleEvent::kNone;
  // kRunning while the step runs; afterwards kDone, or the state in which it failed.
  StepState state_ = StepState::kRunning;
  // Explanation of the state as a sentence; empty if there is nothing to explain.
  std::string reason_;
};

/// Base class of activities whose state is one struct `m` with a function `visit(Archive&)`. A
/// derived class with further state overrides `visit` and calls this version first.
template <class Memory>
class ActivityWith : public Activity {
 public:
  using Activity::Activity;
  /// Saves or loads the state of the base class and `m`.
  void visit(Archive& a) override {
    Activity::visit(a);
    m.visit(a);
  }

 protected:
  /// State of the derived activity.
  Memory m;
};

}  // namespace navvy::control
