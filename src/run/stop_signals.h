// SPDX-License-Identifier: Apache-2.0
// Ends a run at Ctrl-C, SIGTERM or SIGHUP.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <thread>

namespace navvy::run {

/// Listens for SIGINT, SIGTERM and SIGHUP while it exists. One at a time in a process.
///
/// A run asks `asked()` between two steps and calls `obeyed()` before it closes its files. A driver
/// that compiles or does not answer keeps the run from asking: then, kPatience after the signal, a
/// thread of this class writes a summary that says "interrupted" and calls `leave`. A second signal
/// does the same at once. Two signals within half a second count as one, because wrappers such as
/// `timeout` signal a process and then its group.
class StopSignals {
 public:
  /// Ends the process and must not return, as the thread of the run does not react. Receives a
  /// message for the user.
  using Leave = std::function<void(const char* message)>;

  /// Blocks the signals for this thread and those that it starts later, so make it before any other
  /// thread. SIGHUP stays ignored where it was (nohup).
  explicit StopSignals(Leave leave);
  /// Restores the previous handling, unless a signal came: the process is ending then.
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  /// Returns true after a signal.
  static bool asked();
  /// Returns the name of the last signal, e.g. "SIGTERM"; empty before any.
  static std::string name();
  /// Informs the watching thread that the run reacts.
  void obeyed() { obeyed_ = true; }

  /// Time that a run has to react to a signal [ms].
  static constexpr int kPatience = 1200;

 private:
  void watch();
  void leave(bool again);

  Leave leave_;
  std::atomic<bool> obeyed_{false}, over_{false};
  int signals_ = -1;  ///< file that the signals are read from
  std::thread watcher_;
};

}  // namespace navvy::run
