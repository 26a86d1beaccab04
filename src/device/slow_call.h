// SPDX-License-Identifier: Apache-2.0
// Log message about a call that takes long.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace navvy::device {

/// Logs a message once if the object lives longer than a given time. Create one around a driver
/// call that may compile for minutes without output. A second thread does the waiting. Creation
/// costs some tens of microseconds: use it around a build or a first launch, not around every call.
class SlowCall {
 public:
  /// Starts to measure the time; `text` is logged after `seconds` [s]. The text must be complete in
  /// advance, as the thread that logs it cannot query a busy device.
  explicit SlowCall(std::string text, double seconds = kPatience);
  /// Ends the thread at once; waits only if the message is just being logged.
  ~SlowCall();
  SlowCall(const SlowCall&) = delete;
  SlowCall& operator=(const SlowCall&) = delete;

  /// Default of `seconds` [s]; PoCL compiles each kernel of Navvy in 2 to 10 s.
  static constexpr double kPatience = 15;

 private:
  // The thread is declared last: it starts after the other members exist, and is joined before they
  // are destroyed.
  std::mutex mutex_;
  std::condition_variable over_;  ///< ends the wait of the thread before the time is over
  bool done_ = false;             ///< true: the thread must end without logging
  std::thread thread_;            ///< waits, then logs the text
};

}  // namespace navvy::device
