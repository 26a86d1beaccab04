// SPDX-License-Identifier: Apache-2.0
// Kernels built from files of kernels/, and their launches.
//
//   Device device;
//   Buffer<float> heights(device, 1000);
//   const Program program(device, "example/scale.cl", {define("FACTOR", 2)});
//   Kernel kernel(program, "scale");
//   kernel.args(heights, 1000).enqueue(1000);
//   const std::vector<float> result = heights.read();  // waits for the kernel
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "device/buffer.h"
#include "device/device.h"
#include "device/source.h"

namespace navvy::device {

/// Returns the compiler option "-DNAME=value". A number known at compile time lets the driver
/// unroll loops and drop branches. Each value makes another program to compile and store, so use it
/// for numbers with few values.
std::string define(const std::string& name, int value);
/// Returns the same for a float, written so that the kernel gets exactly these bits.
std::string define(const std::string& name, float value);
/// Not offered: a double would silently become an int.
std::string define(const std::string& name, double value) = delete;

/// Returns the flags that all programs on this device are built with; program.cpp gives the
/// reasons. They are common to all, so that two kernels round the same formula alike.
std::vector<std::string> compiler_flags(const DeviceInfo& device);

/// One kernel file with its includes, built for one device. The first build costs up to a second;
/// the driver caches the result. Copies share the program.
class KernelProgram {
 public:
  /// Builds kernels/`path` with the common flags and `options` (from `define`).
  /// @throws DeviceError with the driver's log, which names files of kernels/.
  KernelProgram(Device& device, const std::string& path,
                const std::vector<std::string>& options = {});
  /// Builds a text instead of a file, for small kernels of tests and benches. The log calls it
  /// `name`. The text may include files of kernels/.
  /// @throws DeviceError with the driver's log.
  static KernelProgram from_text(Device& device, const std::string& name, const std::string& text,
                                 const std::vector<std::string>& options = {});

  /// Private to src/device.
  struct State;
  const std::shared_ptr<State>& state() const { return state_; }

 private:
  KernelProgram() = default;
  std::shared_ptr<State> state_;
};

/// Number of work-items (not groups) along each axis. Trailing axes of 1 are left out of the
/// launch.
struct WorkSize {
  WorkSize(std::size_t nx, std::size_t ny = 1, std::size_t nz = 1)
      : n{nx, ny, nz} {}  // NOLINT: a number is a range
  std::size_t n[3];
};

/// Argument that reserves `bytes` of local memory per work-group; its content is undefined at the
/// start of each.
struct LocalMemory {
  std::size_t bytes = 0;
};

/// One kernel of a program. Arguments persist between launches; set a buffer again after it was
/// resized. Copies share the arguments. Launches run in the order of the queue. Not thread-safe.
class Kernel {
 public:
  /// Looks up a kernel by name.
  /// @throws DeviceError if the program has no such kernel.
  Kernel(const KernelProgram& program, const std::string& name);

  /// Sets all arguments in order: buffers, numbers, plain structs, LocalMemory. As all are set, no
  /// kernel runs with an argument of an earlier launch.
  /// @throws DeviceError if their number, or the size of one, does not match the kernel.
  template <class... Args>
  Kernel& args(const Args&... values) {
    expect(sizeof...(values));
    unsigned index = 0;
    (set(index++, values), ...);
    return *this;
  }
  /// Sets one argument by its index, from 0. The buffer must not be resized until the launches that
  /// use it are queued.
  template <class T>
  void set(unsigned index, const Buffer<T>& buffer) {
    set_buffer(index, buffer.raw());
  }
  /// Reserves local memory.
  void set(unsigned index, LocalMemory memory) { set_bytes(index, nullptr, memory.bytes); }
  /// Sets a number or a plain struct, whose layout must equal that of the kernel's compiler; shared
  /// headers assert it.
  template <class T>
  void set(unsigned index, const T& value) {
    static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>,
                  "a kernel takes plain values and buffers");
    static_assert(!std::is_same_v<T, bool>, "bool has no size in OpenCL: pass an int");
    set_bytes(index, &value, sizeof value);
  }

  /// Queues one launch of at least `global` work-items: each axis is rounded up to a multiple of
  /// `local`, so kernels guard their index. Without `local` the driver chooses and nothing is
  /// rounded. An axis of 0 launches nothing. Returns at once; the first launch of a kernel may
  /// compile for seconds.
  /// @throws DeviceError if the driver refuses the launch.
  void enqueue(WorkSize global);
  void enqueue(WorkSize global, WorkSize local);
  /// Queues `groups` work-groups of the kernel's own size (reqd_work_group_size, or one work-item).
  void enqueue_groups(std::size_t groups);

 private:
  // Reports a wrong number of arguments by name; the driver would only fail at the launch.
  void expect(std::size_t count) const;
  void set_buffer(unsigned index, const RawBuffer& buffer);
  void set_bytes(unsigned index, const void* data, std::size_t bytes);
  // All launches go through here: it records the profile and announces a first compilation.
  void launch(const WorkSize& global, const std::size_t* local);
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace navvy::device
