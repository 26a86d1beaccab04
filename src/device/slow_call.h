// SPDX-License-Identifier: Apache-2.0
// Says what a long wait is for.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace navvy::device {

/// While it lives, a thread waits beside the caller; after `seconds` it hands `text` to the log,
/// once. For calls into a driver that may compile for minutes without a word. The end of its life
/// ends the thread and waits for it. Costs a thread, some tens of microseconds, so it goes around a
/// build or a first launch and not around every call.
class SlowCall {
 public:
  /// Starts waiting at once. The text is made beforehand: the thread must not ask a device that is
  /// busy.
  explicit SlowCall(std::string text, double seconds = kPatience);
  /// Returns at once, also before `seconds` are over; waits only for a line that is being logged.
  ~SlowCall();
  SlowCall(const SlowCall&) = delete;
  SlowCall& operator=(const SlowCall&) = delete;

  static constexpr double kPatience = 15;  ///< [s]; all our kernels take PoCL 2 to 10 s

 private:
  // The thread is the last member: it starts when the others are there and is joined before they
  // go.
  std::mutex mutex_;
  std::condition_variable over_;
  bool done_ = false;
  std::thread thread_;
};

}  // namespace navvy::device
