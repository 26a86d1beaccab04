// SPDX-License-Identifier: Apache-2.0
// The built-in operator: runs a program of the scene by joint and drive commands, seeing only what
// can be seen from a cab.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "control/observation.h"
#include "control/outcome.h"
#include "control/planners.h"
#include "control/reach.h"
#include "core/archive.h"
#include "scene/machine.h"
#include "scene/program.h"

namespace navvy::control {

/// Runs the program of one machine. The operator carries out the program's steps one after the
/// other, and each step supplies the activity that carries it out.
///
/// The commands depend only on the operator's state and on the observations, so runs repeat
/// exactly. Every phase of a step has a time limit, so an operator never waits forever. A step that
/// fails (see fell_short) ends the program: the joints stop and the drive brakes. If any step of
/// the program uses the arm, the operator holds the arm in position during all steps, including
/// driving and waiting.
class Operator {
 public:
  /// Prepares `program` for `machine`. `name` is the machine's name in the scene, which messages
  /// use; if it is empty, messages use the model's name. `planners` makes the planners of paths and
  /// of jobs; each is needed only if a step plans such. @throws InputError if the machine lacks a
  /// part that the program needs, or if a step plans paths or jobs and `planners` cannot make their
  /// planner.
  Operator(const scene::Machine& machine, const scene::Program& program, std::string name = "",
           const Planners& planners = {});
  ~Operator();
  Operator(Operator&&) noexcept;
  Operator& operator=(Operator&&) noexcept;

  /// Advances the program by one control step. Returns the commands that are valid until the next
  /// call. `seen` is the machine's current observation, `time` the simulated time [s], and `dt` the
  /// time since the previous call [s].
  Command update(const Observation& seen, double time, double dt);
  /// Returns commands that stop the machine: zero velocity for each joint that the program has
  /// commanded so far; for the drive, the brake with the last steering angle. Other joints get no
  /// command.
  Command stop() const;
  /// Returns true if every step is done and the machine has not tipped over or been buried since.
  /// Once it returns true, `update` only holds the arm.
  bool done() const;
  /// Returns true if the program will not run any further step, either because it is done or
  /// because a step failed. From then on `update` issues no new commands.
  bool ended() const;
  /// Returns the name of the current phase of the running step, such as "drive", "wait" or "tip".
  /// The phases of a dig are "return", "approach", "penetrate", "drag", "curl", "lift", "swing",
  /// "dump" and "look". Returns "idle" between two steps and after the last one. After a failed
  /// step, returns the state of that step, such as "blocked".
  std::string phase() const;
  /// Returns all paths planned so far, in the order in which they were planned. When the program
  /// begins, the operator plans one path for each step that needs one, starting at the pose that
  /// the previous steps will lead to; steps after a job plan when their turn comes. It logs a
  /// warning for each step without a feasible path on the initial ground.
  const std::vector<PlannedPath>& paths() const;
  /// Returns the reports of the completed steps, in order. If a step failed, its report is the last
  /// one. If the machine tips over or is buried after the last step, a second report of that step
  /// is appended.
  const std::vector<StepReport>& reports() const;
  /// Returns a report of the running step as if the step ended now, at the simulated time `time`
  /// [s]. Between two steps, the report is that of the step about to begin. After the program has
  /// ended, returns the last report, or a report with step number 0 if the program has no steps.
  StepReport present(const Observation& seen, double time) const;
  /// Returns the number of completed steps, the number of all steps, and whether a step failed.
  ProgramProgress progress() const;
  /// Returns the event that the last call of `update` reported; kNone if there was none.
  CycleEvent event() const;

  /// Saves or loads the operator's complete state, including the running activity. @throws
  /// InputError if the program to load into has a different step at the saved position.
  void visit(Archive& a);

 private:
  struct State;
  // Complete state of the operator.
  std::unique_ptr<State> state_;
};

}  // namespace navvy::control
