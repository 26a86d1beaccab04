// SPDX-License-Identifier: Apache-2.0
// OpenCL devices: list, pick, queue, profile. No other module sees OpenCL's headers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "device/device_error.h"

namespace navvy::device {

/// What a device is, as far as it decides how kernels are scheduled; never the name of a vendor.
enum class Kind { kCpu, kGpu, kOther };

/// What a device says about itself.
struct DeviceInfo {
  int index = 0;  ///< in the list of all devices, platform by platform
  Kind kind = Kind::kOther;
  std::string name, vendor, platform, version, driver;
  int compute_units = 0;
  /// Global memory [bytes]; what NAVVY_DEVICE_MEMORY_MIB allows when that is less.
  std::uint64_t memory = 0;
  std::uint64_t local_memory = 0;    ///< of one work-group [bytes]
  std::size_t max_work_group = 0;    ///< work-items
  bool shares_memory = false;        ///< with the host: mapped buffers cost no copy
  bool correct_divide_sqrt = false;  ///< single-precision divide and sqrt can be rounded correctly

  /// "0: cpu, pthread-haswell-AMD EPYC (Portable Computing Language, OpenCL 3.0 PoCL ...), 2
  /// compute units, 7.6 GiB".
  std::string text() const;
};

/// Every OpenCL device of every platform; empty when there is none. Never throws for a broken
/// platform, leaves it out. Opens the kernel cache first; the first call of a process loads the
/// drivers.
std::vector<DeviceInfo> list_devices();

/// Time a kernel took on the device, summed over launches. Only counted while the profile is on. It
/// is time on the device's own clock and leaves out launches, copies and waits.
struct KernelTime {
  std::string name;
  std::uint64_t launches = 0;
  double seconds = 0;
};

/// One device with its context and one in-order queue.
///
/// Buffers, programs and kernels made on it keep it alive. Everything is queued in the order it is
/// called; only reads, maps and `finish` wait. Not thread-safe. One queue keeps the order of
/// results independent of the driver: what is repeatable on a device stays so. Moving it is cheap
/// and leaves the source without a device.
class Device {
 public:
  /// Picks a device: "cpu", "gpu", an index of `list_devices`, or a part of a name or platform
  /// (case does not matter). Empty: what the environment variable NAVVY_DEVICE says, else the first
  /// CPU, else the first GPU, else the first. NAVVY_DEVICE_MEMORY_MIB bounds the memory its buffers
  /// may take together [MiB].
  /// @throws DeviceError listing what exists and what to do when nothing matches.
  explicit Device(const std::string& choice = "");
  // Waits for what is queued, when nothing else holds the device any more; never throws.
  ~Device();
  // Not copied: two owners of one queue would have to agree about the profile.
  Device(Device&&) noexcept;
  Device& operator=(Device&&) noexcept;

  /// What the device said when it was picked, with the memory that it is allowed.
  const DeviceInfo& info() const;
  /// Memory that buffers of this device hold now [bytes]. Buffers count in full from their
  /// construction to the last copy's end; programs and the driver's own needs are not in it.
  std::uint64_t memory_used() const;

  /// Waits until everything queued is done. @throws DeviceError when something queued failed.
  void finish();
  /// Hands queued work to the device without waiting. For a host that has other work to do before
  /// it waits; a driver may otherwise hold back launches until somebody does.
  void flush();

  /// Switches the per-kernel profile; off at start. Waits for the queue. Profiling slows a run down
  /// a little, so it is never on by itself.
  void set_profile(bool on);
  /// Device time by kernel name, in alphabetical order, since the profile was switched on or
  /// cleared. Waits.
  std::vector<KernelTime> profile();
  /// Forgets the times so far, and waits, so that what is queued now is not counted later.
  void clear_profile();

  /// Buffers, programs and kernels share it with the device.
  struct State;  ///< private to src/device
  const std::shared_ptr<State>& state() const { return state_; }

 private:
  std::shared_ptr<State> state_;
};

}  // namespace navvy::device
