// SPDX-License-Identifier: Apache-2.0
// The built-in operator: runs a program of the scene by joint and drive commands, seeing only what
// a cab has.
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
/// Deterministic: a function of its state and the observations. Never hangs: every phase has a time
/// limit. A step that falls short ends the program there: what it had set in motion stops, the
/// drive brakes. A program with a step that uses the arm holds the arm all the time, also while the
/// machine drives or waits.
class Operator {
 public:
  /// `name` is what messages call the machine: that of the instance in the scene; empty: the
  /// model's. `planners` is asked where a step needs paths.
  /// @throws InputError when the machine lacks what the program needs, or nobody plans the paths it
  /// asks for.
  Operator(const scene::Machine& machine, const scene::Program& program, std::string name = "",
           const MakePathPlanner& planners = {});
  ~Operator();
  Operator(Operator&&) noexcept;

  /// One control step: what the machine shall do until the next. `time` [s] simulated, `dt` [s]
  /// since the last call.
  Command update(const Observation& seen, double time, double dt);
  /// Commands that stop what the program has set in motion: its joints stand still, the drive
  /// brakes and keeps its steering.
  Command stop() const;
  /// True when every step is done and the machine has not fallen over since; `update` then only
  /// holds the arm.
  bool done() const;
  /// True when the program goes no further: done, or a step fell short; `update` then commands
  /// nothing new.
  bool ended() const;
  /// What the running step calls its phase: "drive", "wait", "tip", in a dig "return", "approach",
  /// "penetrate", "drag", "curl", "lift", "swing", "dump", "look"; "idle" between steps and after
  /// the last; after a step that fell short its state ("blocked").
  std::string phase() const;
  /// Every path planned so far. When the program begins one is planned for each step that will want
  /// one, from where the machine is to stand then; where there is none on the ground as it lies a
  /// warning says so.
  const std::vector<PlannedPath>& paths() const;
  /// What became of the steps that are over, in their order; the last one may have fallen short. A
  /// machine that tips over, or is buried, after its last step has a second report of that step.
  const std::vector<StepReport>& reports() const;
  /// The report of the running step as it would end now at `time` [s]; of the last one over when
  /// none runs, of no step (number 0) before the first.
  StepReport present(const Observation& seen, double time) const;
  /// Digging cycles so far.
  int cycles() const;
  /// Steps of the program that are done, and how many it has.
  ProgramProgress progress() const;
  /// The event of the last update.
  CycleEvent event() const;

  /// The whole state: step, what steps hand on, the running activity. Loading refuses a snapshot
  /// that was taken in a step that the program does not have there.
  void visit(Archive& a);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace navvy::control
