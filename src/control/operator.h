// SPDX-License-Identifier: Apache-2.0
// The built-in operator: runs a program of the scene by joint and drive commands, seeing only what
// can be seen from a cab.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "control/observation.h"
#include "control/outcome.h"
#include "control/path_planner.h"
#include "control/reach.h"
#include "core/archive.h"
#include "scene/machine.h"
#include "scene/program.h"

namespace navvy::control {

/// Runs one machine's program: one activity after the other, each of which knows its own step.
///
/// Deterministic: a function of its state and the observations. Every phase has a time limit, so it
/// never hangs. A step that falls short ends the program there: its joints stop and the drive
/// brakes. A program with a step that uses the arm holds the arm at all times, also while the
/// machine drives or waits.
class Operator {
 public:
  /// Prepares a program. Messages call the machine `name`, its instance in the scene; empty: the
  /// model's name. `planners` makes the planner for steps that need paths. @throws InputError when
  /// the machine lacks what the program needs, or when no planner is given for the paths it asks
  /// for.
  Operator(const scene::Machine& machine, const scene::Program& program, std::string name = "",
           const MakePathPlanner& planners = {});
  ~Operator();
  Operator(Operator&&) noexcept;

  /// Advances by one control step: returns the commands until the next one. `time` is the simulated
  /// time [s], `dt` the time since the last call [s].
  Command update(const Observation& seen, double time, double dt);
  /// Returns commands that stop what the program has set in motion: its joints hold, the drive
  /// brakes and keeps its steering.
  Command stop() const;
  /// Returns true when every step is done and the machine has not tipped over since; `update` then
  /// only holds the arm.
  bool done() const;
  /// Returns true when the program goes no further: it is done, or a step fell short. `update` then
  /// commands nothing new.
  bool ended() const;
  /// Returns the phase of the running step: "drive", "wait", "tip", in a dig "return", "approach",
  /// "penetrate", "drag", "curl", "lift", "swing", "dump", "look"; "idle" between steps and after
  /// the last; after a step that fell short its state, such as "blocked".
  std::string phase() const;
  /// Returns every path planned so far. When the program begins, one is planned for each step that
  /// will need one, from where the machine will then stand; a warning names a step for which none
  /// exists on the present ground.
  const std::vector<PlannedPath>& paths() const;
  /// Returns the reports of the steps that are over, in order; the last one may have fallen short.
  /// A machine that tips over or is buried after its last step has a second report of that step.
  const std::vector<StepReport>& reports() const;
  /// Returns the report of the running step as if it ended now at `time` [s]; of the last completed
  /// step when none runs, and of no step (number 0) before the first.
  StepReport present(const Observation& seen, double time) const;
  /// Returns how many steps the program has and how many are done.
  ProgramProgress progress() const;
  /// Returns the event of the last update.
  CycleEvent event() const;

  /// Visits the whole state: step number, handover, the running activity. @throws InputError for a
  /// snapshot taken in a step that the program does not have there.
  void visit(Archive& a);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace navvy::control
