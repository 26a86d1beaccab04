// SPDX-License-Identifier: Apache-2.0
// Log message about a long wait.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace navvy::device {

/// Logs `text` once if it is alive for longer than `seconds`, for driver calls that may compile for
/// minutes in silence. A thread waits beside the caller. It costs some tens of microseconds: use it
/// around a build or a first launch, not around every call.
class SlowCall {
 public:
  /// Starts waiting at once. The text is prepared beforehand, as the thread must not query a busy
  /// device.
  explicit SlowCall(std::string text, double seconds = kPatience);
  /// Ends the thread at once; waits only for a message that is being logged.
  ~SlowCall();
  SlowCall(const SlowCall&) = delete;
  SlowCall& operator=(const SlowCall&) = delete;

  /// Default wait [s]; PoCL compiles each of our kernels in 2 to 10 s.
  static constexpr double kPatience = 15;

 private:
  // The thread is the last member, so it starts after the others exist and is joined before they
  // are destroyed.
  std::mutex mutex_;
  std::condition_variable over_;
  bool done_ = false;
  std::thread thread_;
};

}  // namespace navvy::device
