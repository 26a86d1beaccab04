// SPDX-License-Identifier: Apache-2.0
// OpenCL devices: listing, selection, queue, profile. No other module includes OpenCL headers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "device/device_error.h"

namespace navvy::device {

/// Type of a device, which decides how kernels are scheduled. The vendor never does.
enum class Kind { kCpu, kGpu, kOther };

/// Properties that a device reports.
struct DeviceInfo {
  /// Index in the list of all devices, platform by platform.
  int index = 0;
  /// Type by which kernels are scheduled.
  Kind kind = Kind::kOther;
  /// Texts as the driver reports them.
  std::string name, platform, version, driver;
  /// Number of units that run work-groups in parallel, the cores of a CPU.
  int compute_units = 0;
  /// Global memory [bytes], or the limit from NAVVY_DEVICE_MEMORY_MIB if that is less.
  std::uint64_t memory = 0;
  /// Largest work-group [work-items].
  std::size_t max_work_group = 0;
  /// True if the device shares the host's memory, so that mapping buffers costs no copy.
  bool shares_memory = false;
  /// True if the device can round single-precision division and square root correctly.
  bool correct_divide_sqrt = false;

  /// Returns e.g. "0: cpu, pthread-haswell-AMD EPYC (Portable Computing Language, OpenCL 3.0 PoCL
  /// ...), 2 compute units, 7.6 GiB".
  std::string text() const;
};

/// Returns the devices of all platforms, or none. A broken platform is left out without an
/// exception. Opens the kernel cache first; the first call in a process loads the drivers.
std::vector<DeviceInfo> list_devices();

/// Time that a kernel took on the device, summed over launches, on the device's clock. Launch
/// overhead, copies and waits are not included. Counted only while the profile is on.
struct KernelTime {
  /// Name of the kernel, without the name of its program.
  std::string name;
  /// Number of launches since the profile was switched on or cleared.
  std::uint64_t launches = 0;
  /// Time on the device [s].
  double seconds = 0;
};

/// One device with its context and one in-order queue.
///
/// Buffers, programs and kernels keep the device alive. Work runs in the order of the calls that
/// queue it; only reads, maps and `finish` wait. With a single queue the order of results does not
/// depend on the driver, so results on a device are repeatable. Not thread-safe. Moving is cheap
/// and leaves the source without a device.
class Device {
 public:
  /// Selects a device: "cpu", "gpu", an index of `list_devices`, or a part of a name or platform
  /// (case-insensitive). For an empty choice the environment variable NAVVY_DEVICE decides, else
  /// the first CPU, the first GPU or the first device is taken. NAVVY_DEVICE_MEMORY_MIB limits the
  /// memory of all its buffers [MiB].
  /// @throws DeviceError if nothing matches; the message lists the devices and says what to do.
  explicit Device(const std::string& choice = "");
  /// Waits for queued work if nothing else holds the device. Never throws.
  ~Device();
  // Not copyable: two owners of one queue would have to agree about the profile.
  Device(Device&&) noexcept;
  Device& operator=(Device&&) noexcept;

  /// Returns what the device reported when it was selected, with the memory that Navvy may use.
  const DeviceInfo& info() const;
  /// Returns the memory of all buffers on this device [bytes]. A buffer counts from its
  /// construction until its last copy is destroyed; programs and the driver's own memory are not
  /// included.
  std::uint64_t memory_used() const;

  /// Waits until all queued work is done.
  /// @throws DeviceError if some of it failed.
  void finish();

  /// Switches the profile of kernels, which is off by default as it slows a run down slightly.
  /// Waits for queued work.
  void set_profile(bool on);
  /// Returns the device time of each kernel, in alphabetical order, since the profile was switched
  /// on or cleared. Waits for queued work.
  std::vector<KernelTime> profile();
  /// Resets the profile. Waits first, so that work that is queued now is not counted later.
  void clear_profile();

  /// OpenCL objects, shared with buffers, programs and kernels. Private to src/device.
  struct State;
  /// Returns the OpenCL objects.
  const std::shared_ptr<State>& state() const { return state_; }

 private:
  std::shared_ptr<State> state_;
};

}  // namespace navvy::device
