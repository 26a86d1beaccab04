// SPDX-License-Identifier: Apache-2.0
// Kernels built from files of kernels/, and their launches.
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

/// "-DNAME=value" with the value written so that the kernel's compiler gets the same bits. Numbers
/// that a kernel knows when it is compiled let the driver unroll loops and drop branches; each
/// other value makes another program, compiled and kept on its own, so give only what takes few
/// values in a run.
std::string define(const std::string& name, int value);
std::string define(const std::string& name, float value);
std::string define(const std::string& name, const std::string& value);

/// The flags every program is built with on this device; the reason of each is in program.cpp. They
/// are the same for every program, so that two kernels cannot round one formula in two ways.
std::vector<std::string> compiler_flags(const DeviceInfo& device);

/// One kernel file with its includes, built for one device. Costs up to a second at the first
/// build; the driver caches it. Copies share one program.
class KernelProgram {
 public:
  /// Builds kernels/`path` with `options` (from `define`) after the common flags.
  /// @throws DeviceError with the driver's log, whose lines name our files.
  KernelProgram(Device& device, const std::string& path,
                const std::vector<std::string>& options = {});
  /// Builds a text instead of a file; `name` is what the log calls it. The text may include files
  /// of kernels/ as a file there could. For small kernels of tests and benches.
  static KernelProgram from_text(Device& device, const std::string& name, const std::string& text,
                                 const std::vector<std::string>& options = {});

  struct State;  ///< private to src/device
  const std::shared_ptr<State>& state() const { return state_; }

 private:
  KernelProgram() = default;
  std::shared_ptr<State> state_;
};

/// Number of work-items along each axis. Axes after the last one that is more than 1 are left out
/// of the launch. The numbers are of work-items, not of groups.
struct WorkSize {
  WorkSize(std::size_t nx, std::size_t ny = 1, std::size_t nz = 1)
      : n{nx, ny, nz} {}  // NOLINT: a number is a range
  std::size_t n[3];
};

/// An argument that reserves `bytes` of local memory. Every work-group has its own; its content is
/// undefined at the start of each.
struct LocalMemory {
  std::size_t bytes = 0;
};

/// One kernel of a program. Arguments stay set between launches; a buffer that was replaced
/// (resized) must be set again. Copies share the arguments too. Not thread-safe; one kernel is used
/// from one place. Launches run in the order of the queue.
class Kernel {
 public:
  /// @throws DeviceError when the program has no kernel of this name.
  Kernel(const KernelProgram& program, const std::string& name);

  /// Sets all arguments in order: buffers, numbers, plain structs, LocalMemory. Every argument is
  /// set, so a kernel never runs with one left over from a launch before.
  /// @throws DeviceError when their count or the size of one does not fit the kernel.
  template <class... Args>
  Kernel& args(const Args&... values) {
    expect(sizeof...(values));
    unsigned index = 0;
    (set(index++, values), ...);
    return *this;
  }
  /// One argument by its place, from 0. A buffer must stay as it is until the launches that use it
  /// are queued.
  template <class T>
  void set(unsigned index, const Buffer<T>& buffer) {
    set_buffer(index, buffer.raw());
  }
  void set(unsigned index, LocalMemory memory) { set_bytes(index, nullptr, memory.bytes); }
  /// A number or a plain struct, which must have the layout that the kernel's compiler gives it:
  /// shared headers assert it.
  template <class T>
  void set(unsigned index, const T& value) {
    static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>,
                  "a kernel takes plain values and buffers");
    static_assert(!std::is_same_v<T, bool>, "bool has no size in OpenCL: pass an int");
    set_bytes(index, &value, sizeof value);
  }

  /// Queues one launch over at least `global` work-items: each axis is rounded up to a multiple of
  /// `local`, so the kernel guards its index. Without `local` the driver chooses and nothing is
  /// rounded. An axis of 0 launches nothing. Returns at once; the first launch of a kernel may
  /// compile for seconds.
  void enqueue(WorkSize global);
  void enqueue(WorkSize global, WorkSize local);
  /// Queues `groups` work-groups of the size the kernel was written for (reqd_work_group_size;
  /// without it, one work-item).
  void enqueue_groups(std::size_t groups);

  /// As in the file, without the name of its program.
  const std::string& name() const;
  /// Largest work-group this kernel can have on its device. It depends on the registers and the
  /// local memory that the kernel uses; ask it before choosing `local`.
  std::size_t max_work_group() const;

 private:
  // Refuses a wrong number of arguments before the driver would report it, at the launch, without
  // saying which.
  void expect(std::size_t count) const;
  void set_buffer(unsigned index, const RawBuffer& buffer);
  void set_bytes(unsigned index, const void* data, std::size_t bytes);
  // The one place that launches: counts the profile and tells of a first compilation.
  void launch(const WorkSize& global, const std::size_t* local);
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace navvy::device
