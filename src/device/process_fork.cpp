// SPDX-License-Identifier: Apache-2.0
#include "device/process_fork.h"

#include <pthread.h>

#include <atomic>
#include <mutex>

#include "device/device_error.h"

namespace navvy::device {
namespace {

std::atomic<bool>& forked() {
  static std::atomic<bool> value{false};
  return value;
}

}  // namespace

// The handler only stores: the child of a process with threads may call little else.
void opencl_has_started() {
  static std::once_flag once;
  std::call_once(once, [] {
    forked() = false;
    pthread_atfork(nullptr, nullptr, [] { forked() = true; });
  });
}

bool forked_after_start() { return forked().load(std::memory_order_relaxed); }

void require_no_fork() {
  if (!forked_after_start()) return;
  throw DeviceError(
      "this process was forked after OpenCL had started, and the driver has no threads here: start "
      "the process with 'spawn' or 'forkserver' (multiprocessing.get_context(\"spawn\"), "
      "AsyncVectorEnv(..., context=\"spawn\")), or fork before the first world is made");
}

}  // namespace navvy::device
