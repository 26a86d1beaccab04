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

struct Device::State {
  DeviceInfo info;
  cl_device_id device = nullptr;
  cl_context context = nullptr;
  cl_command_queue queue = nullptr;
  bool profiling = false;
  std::uint64_t memory_used = 0;                         ///< by buffers [bytes]
  std::vector<std::pair<std::string, cl_event>> events;  ///< launches not yet added to `times`
  std::map<std::string, KernelTime> times;
  /// Since a kernel was launched for the first time: the driver may compile its machine code only then. Ends with the
  /// next wait.
  std::unique_ptr<SlowCall> compiling;

  State() = default;
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State();
  void open_queue();
  void finish();
  /// Adds finished launches to `times`; the queue must be done.
  void collect();
};

/// @throws DeviceError "<call> failed: <symbol>[, kernel <kernel>], on device <name>" unless code is CL_SUCCESS.
void check(cl_int code, const char* call, const Device::State& state, const std::string& kernel = "");

}  // namespace navvy::device
