// SPDX-License-Identifier: Apache-2.0
// The only header that sees OpenCL; included by src/device/*.cpp alone and not installed.
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

/// The OpenCL objects behind a Device, in the order in which they must go: the queue before the
/// context.
struct Device::State {
  DeviceInfo info;
  cl_device_id device = nullptr;
  cl_context context = nullptr;
  cl_command_queue queue = nullptr;
  bool profiling = false;
  /// The driver threw within itself and keeps its locks: nothing is released any more.
  bool lost = false;
  std::uint64_t memory_used = 0;  ///< by buffers [bytes]
  // An event holds driver memory, so the list is emptied when it is long and at every wait.
  std::vector<std::pair<std::string, cl_event>> events;  ///< launches not yet added to `times`
  std::map<std::string, KernelTime> times;
  /// Since a kernel was launched for the first time: the driver may compile its machine code only
  /// then. Ends with the next wait.
  std::unique_ptr<SlowCall> compiling;

  State() = default;
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State();
  // Makes `queue` from `context`, with profiling as the flag says.
  void open_queue();
  // Waits for the queue, ends the notice of a compiling driver and adds up events.
  void finish();
  /// Adds finished launches to `times`; the queue must be done.
  void collect();
};

/// @throws DeviceError "<call> failed: <symbol>[, kernel <kernel>], on device <name>" unless code
/// is CL_SUCCESS.
void check(cl_int code, const char* call, const Device::State& state,
           const std::string& kernel = "");

}  // namespace navvy::device
