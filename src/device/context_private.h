// SPDX-License-Identifier: Apache-2.0
// OpenCL contexts and compiled kernel programs, which all devices of a process share; included by
// src/device/*.cpp only.
#pragma once

#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <utility>

#include "device/launch_guard_private.h"

namespace navvy::device {

/// Number of drivers that may run the kernels of a Device: one with worker threads (index 0), and
/// one that runs them in the caller's thread (index 1).
inline constexpr std::size_t kDrivers = 2;

/// One OpenCL context with the kernel programs that were built in it. Every Device of the same
/// drivers uses the same context, so a program is built once, whatever the number of worlds. It
/// lives as long as one of these devices, their buffers or kernels. Thread-safe.
class SharedContext {
 public:
  /// Drivers of a context; the second one is null without a driver for the caller's thread.
  using Drivers = std::array<cl_device_id, kDrivers>;

  /// Returns the context of these drivers. Makes one if no device uses one, or if the driver of the
  /// present one was lost. `code` receives the result of clCreateContext.
  /// Returns null if that fails.
  static std::shared_ptr<SharedContext> of(cl_platform_id platform, const Drivers& drivers,
                                           cl_int& code);
  /// Takes ownership of `context`.
  SharedContext(cl_context context, const Drivers& drivers);
  ~SharedContext();
  SharedContext(const SharedContext&) = delete;
  SharedContext& operator=(const SharedContext&) = delete;

  /// Returns the OpenCL context.
  cl_context context() const { return context_; }
  /// Returns the driver with this index; null if the context lacks it.
  cl_device_id driver(std::size_t index) const { return drivers_[index]; }
  /// Returns the program that `key` identifies, which must state driver, options and source
  /// completely. The first call makes it by `build`; what that throws leaves nothing behind.
  cl_program program(const std::string& key, const std::function<cl_program()>& build);

  /// Returns the guard of all launches in this context.
  LaunchGuard& guard() { return guard_; }
  /// Notes the first launch of a kernel object, at which the driver may compile machine code.
  void note_launch(cl_program program, const std::string& kernel);
  /// Returns true if programs were built, or kernels launched for the first time, since the last
  /// call: the driver's cache may then hold new files.
  bool take_news();

  /// Notes that the driver has thrown an exception. It then still holds its locks, so no OpenCL
  /// object of this context is released any more.
  void lose() { lost_ = true; }
  /// Returns true if OpenCL objects of this context must not be released: the driver was lost, or
  /// this is a child process.
  bool abandoned() const;

 private:
  Drivers drivers_;
  cl_context context_;
  LaunchGuard guard_;
  std::atomic<bool> lost_ = false;
  /// Guards `programs_`, and lets one thread build at a time.
  std::mutex mutex_;
  std::map<std::string, cl_program> programs_;
  /// Kernels that were launched, by program and name.
  std::set<std::pair<cl_program, std::string>> launched_;
  bool news_ = false;
};

}  // namespace navvy::device
