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

#include "device/device.h"
#include "device/slow_call.h"

namespace navvy::device {

/// Number of drivers that may run the kernels of a Device: one with worker threads (index 0), and
/// one that runs them in the caller's thread (index 1).
inline constexpr std::size_t kDrivers = 2;

/// OpenCL objects of a Device; the queues are released before the context.
struct Device::State {
  DeviceInfo info;  ///< properties of the device
  /// OpenCL handles; null until the constructor of Device has created them. `drivers[1]` and its
  /// queue stay null on platforms without a driver for the caller's thread.
  cl_device_id drivers[kDrivers] = {};
  cl_context context = nullptr;
  cl_command_queue queues[kDrivers] = {};
  std::size_t driver = 0;            ///< index of the driver in use
  cl_command_queue queue = nullptr;  ///< its queue, one of `queues`
  bool profiling = false;            ///< true: kernel times are recorded
  /// True after the driver has thrown an exception. The driver then still holds its locks, so no
  /// OpenCL object is released any more.
  bool lost = false;
  std::uint64_t memory_used = 0;   ///< memory of all buffers [bytes]
  std::uint64_t buffers_made = 0;  ///< number of allocations so far, which numbers each of them
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
  /// Creates the queues in `context`, with event timing if `profiling` is true.
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
