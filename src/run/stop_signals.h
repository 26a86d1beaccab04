// SPDX-License-Identifier: Apache-2.0
// Ends a run on Ctrl-C, SIGTERM or SIGHUP.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <thread>

namespace navvy::run {

/// Receives SIGINT, SIGTERM and SIGHUP while it exists. A process may have only one object of this
/// class at a time.
///
/// The thread of the run calls `asked()` between two steps, and calls `obeyed()` before it closes
/// its files. It cannot do so while an OpenCL driver compiles or does not respond. If `obeyed()`
/// was not called kPatience ms after a signal, a thread of this class writes a summary with the
/// status "interrupted" and calls `leave`. A second signal has this effect at once. Signals within
/// half a second of the first one count as the same signal, because wrappers such as `timeout`
/// signal a process and then its process group.
class StopSignals {
 public:
  /// Function that ends the process immediately and must not return. Receives a message for the
  /// user.
  using Leave = std::function<void(const char* message)>;

  /// Blocks the signals in this thread and in threads that it starts later. Must therefore be
  /// constructed before any other thread. If SIGHUP was ignored before, as with nohup, it remains
  /// ignored.
  explicit StopSignals(Leave leave);
  /// Restores the previous signal handling, except after a signal, because the process is then
  /// about to end.
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  /// Returns true after a signal was received.
  static bool asked();
  /// Returns the name of the last signal, such as "SIGTERM"; empty if none was received.
  static std::string name();
  /// Informs this object that the run reacts to the signal, so that `leave` is not called.
  void obeyed() { obeyed_ = true; }

  /// Time within which a run must react to a signal [ms].
  static constexpr int kPatience = 1200;

 private:
  /// Waits for signals. Runs in the thread `watcher_`.
  void watch();
  /// Writes the summary and calls the function passed to the constructor. `again` is true after a
  /// second signal.
  void leave(bool again);

  /// Function that ends the process.
  Leave leave_;
  /// Set by `obeyed()` (`obeyed_`), and by the destructor to end the thread (`over_`).
  std::atomic<bool> obeyed_{false}, over_{false};
  /// File descriptor from which signals are read; -1 if it could not be opened.
  int signals_ = -1;
  /// Thread that waits for signals.
  std::thread watcher_;
};

}  // namespace navvy::run
