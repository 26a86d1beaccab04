// SPDX-License-Identifier: Apache-2.0
#include "device/slow_call.h"

#include <chrono>
#include <utility>

#include "core/log.h"

namespace navvy::device {

SlowCall::SlowCall(std::string text, double seconds)
    : thread_([this, text = std::move(text), seconds] {
        // The mutex and the condition are declared before the thread, so they exist from its start
        // until it is joined.
        std::unique_lock lock(mutex_);
        const bool ended =
            over_.wait_for(lock, std::chrono::duration<double>(seconds), [this] { return done_; });
        if (!ended) log_info(text);
      }) {}

SlowCall::~SlowCall() {
  {
    // Set under the lock: otherwise the thread might miss it between test and sleep, and wait until
    // its timeout.
    const std::lock_guard lock(mutex_);
    done_ = true;
  }
  over_.notify_one();
  thread_.join();
}

}  // namespace navvy::device
