// SPDX-License-Identifier: Apache-2.0
// OpenCL devices: list, selection, queue, and execution times. No other module includes OpenCL
// headers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "device/device_error.h"

namespace navvy::device {

/// Type of a device. How kernels are scheduled depends on this type, never on the vendor.
enum class Kind { kCpu, kGpu, kOther };

/// Properties that a device reports.
struct DeviceInfo {
  int index = 0;             ///< index in the list of all devices, which is ordered by platform
  Kind kind = Kind::kOther;  ///< type of the device
  /// Name of the device, name of its platform, OpenCL version and driver version, as reported by
  /// the driver.
  std::string name, platform, version, driver;
  int compute_units = 0;  ///< number of units that run work-groups in parallel; for a CPU the cores
  /// Global memory [bytes], or the limit NAVVY_DEVICE_MEMORY_MIB if that is lower.
  std::uint64_t memory = 0;
  std::size_t max_work_group = 0;  ///< maximum size of a work-group [work-items]
  /// True: device and host share memory, so that mapping a buffer copies nothing.
  bool shares_memory = false;
  /// True: float division and square root can be rounded correctly.
  bool correct_divide_sqrt = false;

  /// Returns a description for people, e.g. "0: cpu, pthread-haswell-AMD EPYC (Portable Computing
  /// Language, OpenCL 3.0 PoCL ...), 2 compute units, 7.6 GiB".
  std::string text() const;
};

/// Returns the devices of all platforms; empty if there are none. A platform with errors is skipped
/// without an exception. The first call in a process prepares the kernel cache and loads the
/// drivers.
std::vector<DeviceInfo> list_devices();

/// Execution time of one kernel on the device, summed over all launches while the profile was on.
/// Launch overhead, copies and waiting are not included.
struct KernelTime {
  std::string name;            ///< name of the kernel, without the name of its program
  std::uint64_t launches = 0;  ///< number of launches since the profile was switched on or cleared
  double seconds = 0;          ///< total time on the device, by the device's clock [s]
};

/// One OpenCL device with its context and one in-order queue.
///
/// Buffers, programs and kernels keep the device alive. Queued work runs in the order of the calls;
/// only reads, maps and `finish` wait for it. As there is only one queue, the order of operations
/// does not depend on the driver, so that results on one device are repeatable. Not thread-safe.
/// Moving is cheap and leaves the source without a device.
///
/// With PoCL a device has a second driver without worker threads. Small launches are faster there,
/// as no thread is signalled [docs/soil.md, threads]; results are bit-identical.
class Device {
 public:
  /// Selects a device: "cpu", "gpu", an index in `list_devices`, or a part of a device or platform
  /// name (case-insensitive). If `choice` is empty, the environment variable NAVVY_DEVICE is used
  /// instead; if that is not set, the first CPU, else the first GPU, else the first device.
  /// NAVVY_DEVICE_MEMORY_MIB limits the memory of all buffers on the device [MiB].
  /// @throws DeviceError if no device matches; the message lists the devices and says what to do
  explicit Device(const std::string& choice = "");
  /// Waits for queued work if no buffer, program or kernel uses the device any more. Never throws.
  ~Device();
  // Not copyable: two owners of one queue would have to agree about the profile.
  Device(Device&&) noexcept;
  Device& operator=(Device&&) noexcept;

  /// Returns the properties of the device, with the amount of memory that Navvy may use.
  const DeviceInfo& info() const;
  /// Returns the memory of all buffers on this device [bytes]. A buffer counts from its
  /// construction until its last copy is destroyed; programs and memory that the driver uses itself
  /// are not included.
  std::uint64_t memory_used() const;

  /// Waits until all queued work is done.
  /// @throws DeviceError if any of it failed
  void finish();

  /// Runs all kernels from now on in the caller's thread (true), or in the driver's worker threads
  /// (false, the default). Waits for queued work when that changes something; kernels are compiled
  /// anew at their first launch after the first change. Without a driver for the caller's thread
  /// (has_caller_driver) this does nothing.
  void run_in_caller(bool on);
  /// Returns true if the device has a driver that runs kernels in the caller's thread: PoCL before
  /// version 4, unless the environment variable POCL_DEVICES excludes it (POCL_DEVICES=pthread).
  bool has_caller_driver() const;

  /// Switches the recording of kernel times on or off. It is off by default, as it slows a run down
  /// slightly. Waits for queued work.
  void set_profile(bool on);
  /// Returns the times of all kernels, in alphabetical order, since the profile was switched on or
  /// cleared. Waits for queued work.
  std::vector<KernelTime> profile();
  /// Resets all recorded times. Waits first, so that work already queued is not recorded later.
  void clear_profile();

  /// OpenCL objects, shared with buffers, programs and kernels. Only for use in src/device.
  struct State;
  /// Returns the OpenCL objects.
  const std::shared_ptr<State>& state() const { return state_; }

 private:
  std::shared_ptr<State> state_;  ///< OpenCL objects; null after a move
};

}  // namespace navvy::device
