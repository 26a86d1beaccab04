// SPDX-License-Identifier: Apache-2.0
// Keeps launches of several queues apart where the driver cannot; included by src/device/*.cpp
// only.
#pragma once

#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>

#include <array>
#include <cstddef>
#include <map>
#include <mutex>
#include <set>
#include <shared_mutex>
#include <string>
#include <utility>

namespace navvy::device {

/// Lets the queues of a process launch kernels at the same time, except where PoCL before version 6
/// would abort.
///
/// PoCL loads a kernel again when it is launched over more work-items than its copies allow, and on
/// return takes the newest copy for the one that was running. When two copies of one kernel are in
/// use, the count of users of one of them falls below zero: "pocl_release_dlhandle_cache: Assertion
/// `found->ref_count > 0' failed". Therefore
/// - with worker threads, a launch over more work-items than all before it waits until all queues
///   are empty, its own too, and the others wait for it. These copies stay loaded for ever;
/// - in the caller's thread, a kernel runs once at a time. These copies are unloaded when there are
///   many, so that any launch may load one.
/// Thread-safe.
class LaunchGuard {
 public:
  /// Launches of one kernel so far.
  struct Record {
    /// Largest number of work-items along the first two axes so far, by the size of the groups.
    std::map<std::array<std::size_t, 3>, std::size_t> widest;
    /// Held while the kernel runs in a caller's thread.
    std::mutex running;
  };

  /// Guards launches if `needed` is true. Otherwise does nothing.
  explicit LaunchGuard(bool needed) : needed_(needed) {}

  /// Returns true if the driver keeps a copy of a kernel for each new largest number of work-items.
  bool keeps_copies() const { return needed_; }
  /// Returns true for an OpenCL version text of a driver that needs the guard.
  static bool needed_by(const std::string& version);

  /// Adds a queue; waits until the others are empty.
  void add(cl_command_queue queue);
  /// Removes a queue, which must be empty.
  void remove(cl_command_queue queue);
  /// Returns the record of a kernel of a program; valid as long as the guard.
  Record& record(cl_program program, const std::string& kernel);

  /// Calls `enqueue`, which launches a kernel into `queue` of the driver that runs kernels in the
  /// caller's thread, and returns an OpenCL code; returns that code.
  template <class Enqueue>
  cl_int launch_in_caller(cl_command_queue queue, Record& record, const Enqueue& enqueue) {
    if (!needed_) return enqueue();
    const std::shared_lock<std::shared_mutex> together(mutex_);
    const std::lock_guard<std::mutex> once(record.running);
    const cl_int code = enqueue();
    // Another thread may run what this queue holds: PoCL has one list of commands for all queues.
    if (code == CL_SUCCESS && queues_.size() > kOfOneDevice) clFinish(queue);
    return code;
  }
  /// Calls `enqueue`, which launches a kernel into `queue` and returns an OpenCL code, and returns
  /// that code. `local` is the size of a work-group, null if the driver chooses it; `global` is the
  /// number of work-items along each axis.
  template <class Enqueue>
  cl_int launch(cl_command_queue queue, Record& record, const std::size_t* local,
                const std::size_t* global, const Enqueue& enqueue) {
    if (!needed_) return enqueue();
    const std::array<std::size_t, 3> key = key_of(local);
    const std::size_t width = width_of(global);
    {
      const std::shared_lock<std::shared_mutex> together(mutex_);
      const auto known = record.widest.find(key);
      // The groups that a driver chooses are unknown.
      if (local != nullptr && known != record.widest.end() && width <= known->second)
        return enqueue();
    }
    const std::unique_lock<std::shared_mutex> alone(mutex_);
    finish_all();
    const cl_int code = enqueue();
    if (code != CL_SUCCESS) return code;
    if (queues_.size() > kOfOneDevice) clFinish(queue);
    std::size_t& most = record.widest[key];
    if (width > most) most = width;
    return code;
  }

 private:
  // Number of queues of one device with both drivers.
  static constexpr std::size_t kOfOneDevice = 2;
  static std::array<std::size_t, 3> key_of(const std::size_t* local);
  static std::size_t width_of(const std::size_t* global);
  // Waits until all queues are empty, if there are several devices. Their owners report what fails.
  void finish_all() const;

  const bool needed_;
  // Held together while a kernel is put into a queue, alone while a wider launch runs.
  std::shared_mutex mutex_;
  std::set<cl_command_queue> queues_;
  std::map<std::pair<cl_program, std::string>, Record> records_;
};

}  // namespace navvy::device
