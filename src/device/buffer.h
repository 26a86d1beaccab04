// SPDX-License-Identifier: Apache-2.0
// Typed memory on a device.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "device/device.h"

namespace navvy::device {

/// Untyped device memory, on which Buffer is built. Sizes and offsets are in bytes and are not
/// checked; Buffer adds the type and the checks. Copies share the same memory.
class RawBuffer {
 public:
  RawBuffer() = default;
  /// Allocates `bytes`, but at least 16, as OpenCL has no empty buffers.
  /// @throws DeviceError if the device's memory, or the part of it that Navvy may use, is too
  /// small; the message contains the number of bytes in use
  RawBuffer(Device& device, std::size_t bytes);
  /// Enlarges the memory to `bytes` and preserves the first `keep` bytes; the rest is
  /// uninitialised. Does not wait: the copy is queued on the device.
  void reserve(std::size_t bytes, std::size_t keep);
  /// Copies `bytes` bytes from `data` on the host to the position `offset`. With `wait`, `data` may
  /// be changed as soon as the call returns; without it, only after a later call that waits.
  void write(const void* data, std::size_t offset, std::size_t bytes, bool wait = true);
  /// Copies `bytes` bytes from the position `offset` to `data` on the host. Waits until all work
  /// queued before is done.
  void read(void* data, std::size_t offset, std::size_t bytes) const;
  /// Queues filling a range with copies of a pattern; `bytes` must be a multiple of
  /// `pattern_bytes`. If the pattern's size is not a power of two or exceeds 128 bytes, the host
  /// writes the range instead and waits.
  void fill(const void* pattern, std::size_t pattern_bytes, std::size_t offset, std::size_t bytes);
  /// Intended use of mapped memory: kRead only reads it, kUpdate reads and writes it.
  enum class Access { kRead, kUpdate };
  /// Maps a range into host memory and returns a pointer to it. Without `wait`, the memory must not
  /// be accessed before a later call has waited.
  void* map(Access access, std::size_t offset, std::size_t bytes, bool wait = true) const;
  /// Unmaps the range at the address `at`; kernels queued afterwards see the written values. Errors
  /// are reported by the next call.
  void unmap(void* at) const noexcept;
  /// Returns the size of the allocated memory [bytes].
  std::size_t capacity() const { return capacity_; }
  /// Returns the OpenCL handle, a cl_mem.
  void* handle() const;
  /// Returns the number of the allocated memory on its device, counted from 1; 0 without memory.
  /// Unlike handles, numbers are never used twice.
  std::uint64_t number() const;

 private:
  // Shared, so that a kernel's argument or a copy keeps the memory, and with it the device, alive.
  struct Memory;
  std::shared_ptr<Memory> memory_;
  std::size_t capacity_ = 0;  ///< size of the memory [bytes]
};

/// A range of a buffer that is mapped into host memory until this object is destroyed. The buffer
/// must outlive the object, and no kernel may use the buffer meanwhile. A range must not be mapped
/// twice at the same time: OpenCL leaves the result undefined if two maps write to the same memory.
template <class T>
class Mapped {
  // Map a range once at a time: OpenCL leaves two maps that write to one place undefined.
 public:
  /// Takes ownership of a mapping: `size` values at the address `data`, which `buffer` has mapped.
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
  /// Returns a pointer to the first value; null for an empty range.
  T* data() const { return view_.data(); }
  /// Returns the number of values.
  std::size_t size() const { return view_.size(); }
  /// Returns the value with index `i`, without a check of the range.
  T& operator[](std::size_t i) const { return view_[i]; }
  /// Returns an iterator to the first value.
  T* begin() const { return view_.data(); }
  /// Returns an iterator past the last value.
  T* end() const { return view_.data() + view_.size(); }

  // Null after a move, so that the range is unmapped once.
 private:
  /// Buffer that must be unmapped; null after a move, so that the range is unmapped only once.
  const RawBuffer* buffer_;
  std::span<T> view_;  ///< the mapped values
};

/// Array of `size()` values of type T in device memory. Values are copied as bytes; headers that
/// are compiled for both host and device ensure that both use the same layout. Copies share the
/// same memory.
template <class T>
class Buffer {
  // Values travel as bytes; headers that both compilers read fix the meaning.
  static_assert(std::is_trivially_copyable_v<T>, "device memory holds plain values");

 public:
  Buffer() = default;
  /// Allocates `size` uninitialised values.
  /// @throws DeviceError if there is not enough memory
  Buffer(Device& device, std::size_t size) : raw_(device, size * sizeof(T)), size_(size) {}
  /// Allocates memory for `values`, copies them and waits until they are on the device.
  /// @throws DeviceError if there is not enough memory
  Buffer(Device& device, std::span<const T> values) : Buffer(device, values.size()) {
    write(values);
  }
  /// Allocates memory for the values of a vector, copies them and waits until they are on the
  /// device.
  Buffer(Device& device, const std::vector<T>& values)
      : Buffer(device, std::span<const T>(values)) {}

  /// Returns the number of values, which may be less than the memory can hold.
  std::size_t size() const { return size_; }
  /// Returns true if the buffer has no values.
  bool empty() const { return size_ == 0; }

  /// Changes the number of values to `size`; values with an index below both the old and the new
  /// size are preserved. The memory is replaced only if it is too small, and then grows by at least
  /// half its size. Kernel arguments must be set again afterwards.
  void resize(std::size_t size) {
    const std::size_t bytes = size * sizeof(T);
    if (bytes > raw_.capacity())
      raw_.reserve(std::max(bytes, raw_.capacity() + raw_.capacity() / 2), size_ * sizeof(T));
    size_ = size;
  }

  /// Copies `values` to the elements from index `at` onwards and waits.
  /// @throws DeviceError if the range is outside the buffer
  void write(std::span<const T> values, std::size_t at = 0) {
    need(at, values.size());
    raw_.write(values.data(), at * sizeof(T), values.size() * sizeof(T));
  }
  /// Copies `values` to the elements from index `at` onwards without waiting: `values` must remain
  /// valid and unchanged until a later call has waited.
  void write_later(std::span<const T> values, std::size_t at = 0) {
    need(at, values.size());
    raw_.write(values.data(), at * sizeof(T), values.size() * sizeof(T), false);
  }
  /// Copies the elements from index `at` onwards to `values`, as many as it holds, and waits.
  /// @throws DeviceError if the range is outside the buffer
  void read(std::span<T> values, std::size_t at = 0) const {
    need(at, values.size());
    raw_.read(values.data(), at * sizeof(T), values.size() * sizeof(T));
  }
  /// Returns a copy of all values. It allocates memory, so use it in tests and outside time steps.
  std::vector<T> read() const {
    std::vector<T> values(size_);
    read(values);
    return values;
  }
  /// Queues setting `count` elements from index `at` onwards (default: all) to `value`. If the size
  /// of T is not a power of two or exceeds 128 bytes, the host writes the values and waits.
  /// @throws DeviceError if the range is outside the buffer
  void fill(const T& value, std::size_t at = 0, std::size_t count = npos) {
    if (count == npos) count = size_ - at;
    need(at, count);
    raw_.fill(&value, sizeof(T), at * sizeof(T), count * sizeof(T));
  }

  /// Maps `count` elements from index `at` onwards (default: all remaining ones) for reading, and
  /// waits for work queued before.
  /// @throws DeviceError if the range is outside the buffer, as do the maps below
  Mapped<const T> map_read(std::size_t at = 0, std::size_t count = npos) const {
    return mapped<const T>(RawBuffer::Access::kRead, at, count);
  }
  /// Maps `count` elements from index `at` onwards (default: all remaining ones) for reading,
  /// without waiting: the values are valid only after a later call has waited.
  Mapped<const T> map_read_later(std::size_t at = 0, std::size_t count = npos) const {
    return mapped<const T>(RawBuffer::Access::kRead, at, count, false);
  }
  /// Maps `count` elements from index `at` onwards (default: all remaining ones) for reading and
  /// writing. If host and device do not share memory, this copies the elements in each direction.
  Mapped<T> map_update(std::size_t at = 0, std::size_t count = npos) {
    return mapped<T>(RawBuffer::Access::kUpdate, at, count);
  }

  /// Returns the untyped memory, which Kernel sets as an argument.
  const RawBuffer& raw() const { return raw_; }

 private:
  /// Default of `count`: all elements up to the end.
  static constexpr std::size_t npos = static_cast<std::size_t>(-1);
  /// Checks that the range of `count` elements from index `at` onwards is in the buffer; the
  /// comparison cannot overflow.
  /// @throws DeviceError if it is not
  void need(std::size_t at, std::size_t count) const {
    if (at > size_ || count > size_ - at) {
      throw DeviceError("buffer of " + std::to_string(size_) + " values: range " +
                        std::to_string(at) + " + " + std::to_string(count) + " is outside");
    }
  }
  /// Maps `count` elements from index `at` onwards for `access`; with `wait`, waits for work queued
  /// before. An empty range is not mapped, as OpenCL refuses it.
  template <class U>
  Mapped<U> mapped(RawBuffer::Access access, std::size_t at, std::size_t count,
                   bool wait = true) const {
    if (count == npos) count = at <= size_ ? size_ - at : 0;
    need(at, count);
    void* data = count == 0 ? nullptr : raw_.map(access, at * sizeof(T), count * sizeof(T), wait);
    return Mapped<U>(&raw_, static_cast<U*>(data), count);
  }
  RawBuffer raw_;         ///< the memory, which may hold more than `size_` values
  std::size_t size_ = 0;  ///< number of values
};

}  // namespace navvy::device
