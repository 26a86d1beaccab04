// SPDX-License-Identifier: Apache-2.0
// Interface of objects that follow a run step by step.
#pragma once

namespace navvy::run {

/// Follows a simulation from step to step, such as a map publisher or a display. All functions are
/// called on the thread that runs the simulation. An exception from `after_step` or `restart` ends
/// the run as failed.
class RunObserver {
 public:
  /// Allows deletion through a base class pointer.
  virtual ~RunObserver() = default;
  /// Called after each step, once the step was recorded.
  virtual void after_step() {}
  /// Called after Simulation::reset or Simulation::load replaced the state, before the next step or
  /// before the end of the run.
  virtual void restart() {}
  /// Called once after the last step, before files are closed. Also called after a failure.
  virtual void closing() {}
  /// Called once with the final state. It is called before the summary is written, so an exception
  /// makes the run a failed one. After a failure it is called after the summary was written.
  virtual void finish() {}
};

}  // namespace navvy::run
