// SPDX-License-Identifier: Apache-2.0
// What takes part in a run beside its recorder.
#pragma once

namespace navvy::run {

/// Follows a simulation from step to step, as a publisher or a display does. Functions are called
/// on the thread that steps. What `after_step` and `restart` throw makes the run a failed one.
class RunObserver {
 public:
  virtual ~RunObserver() = default;
  /// Called after each step has been recorded.
  virtual void after_step() {}
  /// Called after `reset` or `load`, before the next step or the end: the state is another one.
  virtual void restart() {}
  /// Called once when no step follows any more, before files are closed, also after a failure.
  virtual void closing() {}
  /// Called once with the final state. After a run that did not fail it comes before the summary is
  /// written, and what it throws makes the run a failed one.
  virtual void finish() {}
};

}  // namespace navvy::run
