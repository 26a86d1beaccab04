// SPDX-License-Identifier: Apache-2.0
// The only header that includes OpenCL; included by src/device/*.cpp only and not installed.
#pragma once

#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "device/device.h"
#include "device/slow_call.h"

namespace navvy::device {

/// OpenCL objects behind a Device; the queue is released before the context.
struct Device::State {
  DeviceInfo info;
  /// Handles of OpenCL; null until the constructor of Device has created them.
  cl_device_id device = nullptr;
  cl_context context = nullptr;
  cl_command_queue queue = nullptr;
  bool profiling = false;
  /// True after the driver threw within itself. It keeps its locks, so nothing is released any
  /// more.
  bool lost = false;
  /// Memory of all buffers [bytes].
  std::uint64_t memory_used = 0;
  /// Launches that are not yet added to `times`. Events hold driver memory, so the list is emptied
  /// at every wait and when it grows long.
  std::vector<std::pair<std::string, cl_event>> events;
  /// Profile by kernel name.
  std::map<std::string, KernelTime> times;
  /// Notice of a slow compilation, alive from the first launch of a kernel, when the driver may
  /// compile machine code, until the next wait.
  std::unique_ptr<SlowCall> compiling;

  State() = default;
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State();
  /// Creates `queue` in `context`, with profiling as set.
  void open_queue();
  /// Waits for the queue, ends the notice of a slow compilation and collects events.
  void finish();
  /// Adds finished launches to `times`. All queued work must be done.
  void collect();
};

/// Checks the result of an OpenCL call.
/// @throws DeviceError "<call> failed: <symbol>[, kernel <kernel>], on device <name>" unless `code`
/// is CL_SUCCESS.
void check(cl_int code, const char* call, const Device::State& state,
           const std::string& kernel = "");

}  // namespace navvy::device
