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
#include <cstdint>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "device/buffer.h"
#include "device/device.h"
#include "device/source.h"

namespace navvy::device {

/// Returns the compiler option "-DNAME=value". With a number known at compile time, the driver can
/// unroll loops and remove branches. Each value gives a separate program to compile and store, so
/// use it only for numbers with few different values.
std::string define(const std::string& name, int value);
/// Returns the compiler option "-DNAME=value" for a float, written such that the kernel receives
/// exactly the same value.
std::string define(const std::string& name, float value);
/// Deleted: a double would otherwise be converted to an int without a message.
std::string define(const std::string& name, double value) = delete;

/// Returns the compiler flags for all programs on this device; kernel_program.cpp gives the
/// reasons. All programs use the same flags, so that two kernels round the same formula alike.
std::vector<std::string> compiler_flags(const DeviceInfo& device);

/// One kernel file with its includes, built for one device. The first build takes up to a second;
/// the driver caches the result. Copies share the same program.
class KernelProgram {
 public:
  /// Builds the file `path`, relative to kernels/, with the common flags and `options` (from
  /// `define`).
  /// @throws DeviceError with the driver's build log, which refers to the files in kernels/
  KernelProgram(Device& device, const std::string& path,
                const std::vector<std::string>& options = {});
  /// Builds a text instead of a file, for small kernels of tests and benchmarks. The build log
  /// refers to the text as `name`. The text may include files of kernels/.
  /// @throws DeviceError with the driver's build log
  static KernelProgram from_text(Device& device, const std::string& name, const std::string& text,
                                 const std::vector<std::string>& options = {});

  /// OpenCL program and device. Only for use in src/device.
  struct State;
  /// Returns the OpenCL objects of the program.
  const std::shared_ptr<State>& state() const { return state_; }

 private:
  KernelProgram() = default;
  std::shared_ptr<State> state_;
};

/// Number of work-items (not of work-groups) along each axis of a launch. Trailing axes with the
/// value 1 are omitted.
struct WorkSize {
  /// Stores the numbers along up to three axes; a single number converts implicitly.
  WorkSize(std::size_t nx, std::size_t ny = 1, std::size_t nz = 1)
      : n{nx, ny, nz} {}  // NOLINT: a number is a range
  std::size_t n[3];       ///< number of work-items along each axis
};

/// Kernel argument that reserves `bytes` of local memory for each work-group. Its content is
/// undefined when a work-group starts.
struct LocalMemory {
  std::size_t bytes = 0;  ///< size per work-group [bytes]
};

/// One kernel of a program. Arguments persist between launches, but a buffer must be set again
/// after it has been resized. Copies share the arguments. Launches run in the order in which they
/// are queued. Not thread-safe.
class Kernel {
 public:
  /// Finds the kernel `name` in a program.
  /// @throws DeviceError if the program has no such kernel
  Kernel(const KernelProgram& program, const std::string& name);

  /// Sets all arguments in order: buffers, numbers, plain structs or LocalMemory. As all are set at
  /// once, no kernel runs with an argument of an earlier launch. Returns this kernel.
  /// @throws DeviceError if the number of arguments or the size of one does not match the kernel
  template <class... Args>
  Kernel& args(const Args&... values) {
    expect(sizeof...(values));
    unsigned index = 0;
    (set(index++, values), ...);
    return *this;
  }
  /// Sets the argument with the 0-based `index` to a buffer. The buffer must not be resized before
  /// the launches that use it have been queued.
  template <class T>
  void set(unsigned index, const Buffer<T>& buffer) {
    set_buffer(index, buffer.raw());
  }
  /// Sets the argument with the 0-based `index` to local memory, which is reserved per work-group.
  void set(unsigned index, LocalMemory memory) { set_bytes(index, nullptr, memory.bytes); }
  /// Sets the argument with the 0-based `index` to a number or a plain struct. A struct must have
  /// the same layout on host and device; headers shared by both assert it.
  template <class T>
  void set(unsigned index, const T& value) {
    static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>,
                  "a kernel takes plain values and buffers");
    static_assert(!std::is_same_v<T, bool>, "bool has no size in OpenCL: pass an int");
    set_bytes(index, &value, sizeof value);
  }

  /// Queues a launch of `global` work-items; the driver chooses the work-group size. An axis of 0
  /// launches nothing. Returns at once, but the first launch of a kernel may compile it for some
  /// seconds.
  /// @throws DeviceError if the driver refuses the launch
  void enqueue(WorkSize global);
  /// Queues a launch of at least `global` work-items in work-groups of `local` work-items. Each
  /// axis of `global` is rounded up to a multiple of `local`, so kernels must check their index. An
  /// axis of 0 launches nothing.
  /// @throws DeviceError if the driver refuses the launch
  void enqueue(WorkSize global, WorkSize local);
  /// Queues a launch of `groups` work-groups with the size that the kernel declares
  /// (reqd_work_group_size), or of one work-item each.
  void enqueue_groups(std::size_t groups);

 private:
  /// Checks that the kernel has `count` arguments. The message names the kernel; the driver itself
  /// would report an error only at the launch.
  void expect(std::size_t count) const;
  /// Sets the argument with the 0-based `index` to a buffer.
  void set_buffer(unsigned index, const RawBuffer& buffer);
  /// Sets the argument with the 0-based `index` to a copy of `bytes` bytes at `data`. If `data` is
  /// null, reserves `bytes` bytes of local memory per work-group instead. `buffer`: number of the
  /// buffer whose handle the bytes are, or 0. Nothing is passed to the driver if the kernel has the
  /// argument already.
  void set_bytes(unsigned index, const void* data, std::size_t bytes, std::uint64_t buffer = 0);
  /// Queues a launch; all launches use this function. It records the profile and announces a first
  /// compilation. A null `local` lets the driver choose the work-group size.
  void launch(const WorkSize& global, const std::size_t* local);
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace navvy::device
