// SPDX-License-Identifier: Apache-2.0
// The only header that includes OpenCL; included by src/device/*.cpp only and not installed.
#pragma once

#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "device/context_private.h"
#include "device/device.h"
#include "device/process_fork.h"
#include "device/slow_call.h"

namespace navvy::device {

/// OpenCL objects of a Device: the context that it shares, and queues of its own, which are
/// released before the context.
struct Device::State {
  DeviceInfo info;  ///< properties of the device
  /// Context and kernel programs; null until the constructor of Device has found them.
  std::shared_ptr<SharedContext> shared;
  /// One queue per driver of the context; null for a driver that it lacks.
  cl_command_queue queues[kDrivers] = {};
  std::size_t driver = 0;            ///< index of the driver in use
  cl_command_queue queue = nullptr;  ///< its queue, one of `queues`
  bool profiling = false;            ///< true: kernel times are recorded
  std::uint64_t memory_used = 0;     ///< memory of all buffers [bytes]
  std::uint64_t buffers_made = 0;    ///< number of allocations so far, which numbers each of them
  /// Kernel name and event of each launch whose time has not been added to `times`. Events use
  /// memory of the driver, so the list is emptied at every wait and when it becomes long.
  std::vector<std::pair<std::string, cl_event>> events;
  std::map<std::string, KernelTime> times;  ///< recorded times, keyed by kernel name
  /// Notice of a slow compilation. It exists from the first launch of a kernel, at which the driver
  /// may compile machine code, until the next wait.
  std::unique_ptr<SlowCall> compiling;

  State() = default;
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State();
  /// Creates the queues in the context, with event timing if `profiling` is true.
  void open_queues();
  /// Waits for the queue, removes the notice of a slow compilation and collects the events.
  void finish();
  /// Adds the times of finished launches to `times`. All queued work must be done.
  void collect();
};

/// Checks the result of an OpenCL call.
/// @throws DeviceError "<call> failed: <symbol>[, kernel <kernel>], on device <name>" if `code` is
/// not CL_SUCCESS
void check(cl_int code, const char* call, const Device::State& state,
           const std::string& kernel = "");

}  // namespace navvy::device
