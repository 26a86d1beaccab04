// SPDX-License-Identifier: Apache-2.0
// Typed memory on a device.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "device/device.h"

namespace navvy::device {

/// Untyped device memory behind Buffer. Sizes and offsets are in bytes and are not checked; Buffer
/// adds the type and the checks. Copies share their memory.
class RawBuffer {
 public:
  RawBuffer() = default;
  /// Allocates at once, and at least 16 bytes, as OpenCL has no empty buffers.
  /// @throws DeviceError if the device's memory, or the share of it that Navvy may use, does not
  /// suffice; the message holds the bytes in use.
  RawBuffer(Device& device, std::size_t bytes);
  /// Grows the memory to `bytes`, preserving the first `keep` of them; the rest is uninitialised.
  /// Does not wait: the copy is queued on the device.
  void reserve(std::size_t bytes, std::size_t keep);
  /// Copies from the host. With `wait`, the data may change when it returns; without, only after a
  /// later call has waited.
  void write(const void* data, std::size_t offset, std::size_t bytes, bool wait = true);
  /// Copies to the host and waits for all work queued before.
  void read(void* data, std::size_t offset, std::size_t bytes) const;
  /// Queues filling a range with a pattern; the range is a multiple of the pattern. A pattern whose
  /// size is no power of two or exceeds 128 bytes is repeated by the host, which waits.
  void fill(const void* pattern, std::size_t pattern_bytes, std::size_t offset, std::size_t bytes);
  /// Use of mapped memory by the caller: kRead reads it, kUpdate reads and writes it.
  enum class Access { kRead, kUpdate };
  /// Maps a range to host memory. Without `wait` the pointer is valid, but the values are there
  /// only after a later call has waited.
  void* map(Access access, std::size_t offset, std::size_t bytes, bool wait = true) const;
  /// Unmaps a range; kernels queued afterwards see what was written. Errors appear at the next
  /// call.
  void unmap(void* at) const noexcept;
  /// Returns the size of the allocated memory [bytes].
  std::size_t capacity() const { return capacity_; }
  /// Returns the cl_mem.
  void* handle() const;

 private:
  // Shared, so that a kernel's argument or a copy keeps the memory, and with it the device, alive.
  struct Memory;
  std::shared_ptr<Memory> memory_;
  std::size_t capacity_ = 0;
};

/// Mapped range of a buffer, which is unmapped on destruction. The buffer must outlive it, and no
/// kernel may use the buffer meanwhile.
template <class T>
class Mapped {
  // Map a range once at a time: OpenCL leaves two maps that write to one place undefined.
 public:
  /// Takes over `size` values at `data` that `buffer` has mapped.
  Mapped(const RawBuffer* buffer, T* data, std::size_t size) : buffer_(buffer), view_(data, size) {}
  Mapped(Mapped&& other) noexcept
      : buffer_(std::exchange(other.buffer_, nullptr)), view_(other.view_) {}
  Mapped(const Mapped&) = delete;
  Mapped& operator=(const Mapped&) = delete;
  Mapped& operator=(Mapped&&) = delete;
  ~Mapped() {
    if (buffer_ != nullptr && !view_.empty())
      buffer_->unmap(const_cast<std::remove_const_t<T>*>(view_.data()));
  }
  /// Returns the values. The span is empty for an empty range, which is not mapped.
  std::span<T> span() const { return view_; }
  /// Access like a span's; valid until this object is destroyed.
  T* data() const { return view_.data(); }
  std::size_t size() const { return view_.size(); }
  T& operator[](std::size_t i) const { return view_[i]; }
  T* begin() const { return view_.data(); }
  T* end() const { return view_.data() + view_.size(); }

  // Null after a move, so that the range is unmapped once.
 private:
  const RawBuffer* buffer_;
  std::span<T> view_;
};

// Values travel as bytes; headers that both compilers read fix their layout.
template <class T>
class Buffer {
  // Values travel as bytes; headers that both compilers read fix the meaning.
  static_assert(std::is_trivially_copyable_v<T>, "device memory holds plain values");

 public:
  Buffer() = default;
  /// Allocates `size` uninitialised values.
  /// @throws DeviceError if the memory does not suffice.
  Buffer(Device& device, std::size_t size) : raw_(device, size * sizeof(T)), size_(size) {}
  /// Copies host values and waits until they are on the device.
  /// @throws DeviceError if the memory does not suffice.
  Buffer(Device& device, std::span<const T> values) : Buffer(device, values.size()) {
    write(values);
  }
  Buffer(Device& device, const std::vector<T>& values)
      : Buffer(device, std::span<const T>(values)) {}

  /// Returns the number of values, which may be less than the memory can hold.
  std::size_t size() const { return size_; }
  /// Returns true for a buffer without values.
  bool empty() const { return size_ == 0; }

  /// Changes the number of values, preserving the first min(old, new). Memory is replaced only when
  /// it must grow, then by at least a half; set kernel arguments again after growing.
  void resize(std::size_t size) {
    const std::size_t bytes = size * sizeof(T);
    if (bytes > raw_.capacity())
      raw_.reserve(std::max(bytes, raw_.capacity() + raw_.capacity() / 2), size_ * sizeof(T));
    size_ = size;
  }

  /// Copies `values` to offset `at` [values] and waits.
  /// @throws DeviceError if the range is outside of the buffer.
  void write(std::span<const T> values, std::size_t at = 0) {
    need(at, values.size());
    raw_.write(values.data(), at * sizeof(T), values.size() * sizeof(T));
  }
  /// Copies `values` without waiting: they must stay valid and unchanged until a later call has
  /// waited.
  void write_later(std::span<const T> values, std::size_t at = 0) {
    need(at, values.size());
    raw_.write(values.data(), at * sizeof(T), values.size() * sizeof(T), false);
  }
  /// Copies `values.size()` values from offset `at` [values] and waits.
  /// @throws DeviceError if the range is outside of the buffer.
  void read(std::span<T> values, std::size_t at = 0) const {
    need(at, values.size());
    raw_.read(values.data(), at * sizeof(T), values.size() * sizeof(T));
  }
  /// Returns a copy of all values. Convenient, but allocates: use it in tests and outside of time
  /// steps.
  std::vector<T> read() const {
    std::vector<T> values(size_);
    read(values);
    return values;
  }
  /// Queues setting `count` values from `at` on (default: all) to `value`. The device fills values
  /// whose size is a power of two up to 128 bytes; others are written by the host, which waits.
  /// @throws DeviceError if the range is outside.
  void fill(const T& value, std::size_t at = 0, std::size_t count = npos) {
    if (count == npos) count = size_ - at;
    need(at, count);
    raw_.fill(&value, sizeof(T), at * sizeof(T), count * sizeof(T));
  }

  /// Maps `count` values from `at` on (default: all that follow) for reading, and waits for work
  /// queued before.
  /// @throws DeviceError if the range is outside, like the maps below.
  Mapped<const T> map_read(std::size_t at = 0, std::size_t count = npos) const {
    return mapped<const T>(RawBuffer::Access::kRead, at, count);
  }
  /// Maps values for reading without waiting: they are valid only after a later call has waited.
  Mapped<const T> map_read_later(std::size_t at = 0, std::size_t count = npos) const {
    return mapped<const T>(RawBuffer::Access::kRead, at, count, false);
  }
  /// Maps values for reading and writing. Costs a copy in both directions if memory is not shared.
  Mapped<T> map_update(std::size_t at = 0, std::size_t count = npos) {
    return mapped<T>(RawBuffer::Access::kUpdate, at, count);
  }

  /// Returns the untyped memory, which Kernel sets as an argument.
  const RawBuffer& raw() const { return raw_; }

 private:
  static constexpr std::size_t npos = static_cast<std::size_t>(-1);
  /// @throws DeviceError if the range is outside. The comparison cannot overflow.
  void need(std::size_t at, std::size_t count) const {
    if (at > size_ || count > size_ - at) {
      throw DeviceError("buffer of " + std::to_string(size_) + " values: range " +
                        std::to_string(at) + " + " + std::to_string(count) + " is outside");
    }
  }
  // An empty range is not mapped, as OpenCL refuses it.
  template <class U>
  Mapped<U> mapped(RawBuffer::Access access, std::size_t at, std::size_t count,
                   bool wait = true) const {
    if (count == npos) count = at <= size_ ? size_ - at : 0;
    need(at, count);
    void* data = count == 0 ? nullptr : raw_.map(access, at * sizeof(T), count * sizeof(T), wait);
    return Mapped<U>(&raw_, static_cast<U*>(data), count);
  }
  RawBuffer raw_;
  std::size_t size_ = 0;
};

}  // namespace navvy::device
