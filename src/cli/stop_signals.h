// SPDX-License-Identifier: Apache-2.0
// Ctrl-C, SIGTERM and SIGHUP end a run: between two steps where it comes to one, from beside it
// where it does not.
#pragma once

#include <atomic>
#include <string>
#include <thread>

namespace navvy::cli {

/// Listens while it lives; one at a time.
///
/// A run looks at `asked()` between two steps and says `obeyed()` before it closes its files. A
/// driver that compiles or does not answer keeps it from looking: then, kPatience after the signal,
/// a thread of this class leaves a summary that says "interrupted" and ends the process with status
/// 130. So does a second signal, at once; one that comes twice within half a second is one.
class StopSignals {
 public:
  /// To be made before any other thread, which inherits that these signals are not for it. SIGHUP
  /// stays ignored where it was (nohup).
  StopSignals();
  /// From here on the process does at these signals what it did before; nothing after one has come,
  /// as it is ending.
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  /// True after a signal.
  static bool asked();
  /// The last one: "SIGTERM"; empty before any.
  static std::string name();
  /// The run has seen it.
  void obeyed() { obeyed_ = true; }

  static constexpr int kPatience = 1200;  ///< [ms]

 private:
  void watch();

  std::atomic<bool> obeyed_{false}, over_{false};
  int signals_ = -1;  ///< file that the signals are read from
  std::thread watcher_;
};

}  // namespace navvy::cli
