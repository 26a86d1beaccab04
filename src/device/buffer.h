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

/// Untyped memory behind Buffer; sizes and offsets in bytes. Buffer is a thin front that knows the
/// type and checks ranges; nothing here checks them again. Copies of a RawBuffer share their
/// memory.
class RawBuffer {
 public:
  RawBuffer() = default;
  /// Takes the memory at once and never less than 16 bytes, as OpenCL knows no empty buffers.
  /// @throws DeviceError when the device's memory, or what it is allowed of it, does not suffice;
  /// the message holds what is in use.
  RawBuffer(Device& device, std::size_t bytes);
  /// Makes room for `bytes`, keeping the first `keep` of them. The rest is not initialised. Does
  /// not wait: the copy is queued on the device.
  void reserve(std::size_t bytes, std::size_t keep);
  /// Copies from the host. With `wait` the data may change when it returns; without, only after a
  /// later call has waited.
  void write(const void* data, std::size_t offset, std::size_t bytes, bool wait = true);
  /// Copies to the host and waits for everything queued before.
  void read(void* data, std::size_t offset, std::size_t bytes) const;
  /// Queues a copy between two buffers of one device. The ranges must not overlap where both are
  /// one buffer.
  void copy_from(const RawBuffer& other, std::size_t from, std::size_t to, std::size_t bytes);
  /// Queues repeating a pattern over the range; both sizes in bytes, the range a multiple of the
  /// pattern. A pattern that is not a power of two or longer than 128 bytes is repeated by the
  /// host, which waits.
  void fill(const void* pattern, std::size_t pattern_bytes, std::size_t offset, std::size_t bytes);
  /// What the caller will do with mapped memory. kOverwrite promises that every byte is written:
  /// what was there is undefined meanwhile.
  enum class Access { kRead, kOverwrite, kUpdate };
  /// The range as host memory. Without `wait` the pointer is valid but its values are there only
  /// once a later call has waited.
  void* map(Access access, std::size_t offset, std::size_t bytes, bool wait = true) const;
  /// Gives a mapped range back; kernels queued afterwards see what was written. Errors show at the
  /// next call.
  void unmap(void* at) const noexcept;
  /// Bytes that fit without new memory.
  std::size_t capacity() const { return capacity_; }
  void* handle() const;  ///< the cl_mem

 private:
  // Shared, so that a program's argument or a copy keeps the memory, and with it the device, alive.
  struct Memory;
  std::shared_ptr<Memory> memory_;
  std::size_t capacity_ = 0;
};

/// A mapped range of a buffer; unmaps when it goes. The buffer must outlive it, and no kernel may
/// use the buffer meanwhile.
template <class T>
class Mapped {
  // At most one map of a range at a time: OpenCL leaves two that write to one place undefined.
 public:
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
  // The view is of the host. It is empty for an empty range, where nothing was mapped and nothing
  // is given back.
  std::span<T> span() const { return view_; }
  T* data() const { return view_.data(); }
  std::size_t size() const { return view_.size(); }
  T& operator[](std::size_t i) const { return view_[i]; }
  T* begin() const { return view_.data(); }
  T* end() const { return view_.data() + view_.size(); }

  // Null after it was moved from, so that the range is given back once.
 private:
  const RawBuffer* buffer_;
  std::span<T> view_;
};

/// `size()` values of T on one device, zero-copy when the device shares the host's memory.
///
/// New memory is not initialised. An empty buffer is allowed and can be a kernel's argument. Moving
/// is cheap, copying is not offered. `write`, `read` and maps wait for what was queued before;
/// `fill`, `copy_from`, `resize` and what is called `..._later` do not wait.
template <class T>
class Buffer {
  // Only plain values travel by bytes; what the bytes mean is settled by headers that both
  // compilers read.
  static_assert(std::is_trivially_copyable_v<T>, "device memory holds plain values");

 public:
  Buffer() = default;
  /// `size` values, not initialised. @throws DeviceError when memory does not suffice.
  Buffer(Device& device, std::size_t size) : raw_(device, size * sizeof(T)), size_(size) {}
  /// A copy of host values; waits until they are there.
  Buffer(Device& device, std::span<const T> values) : Buffer(device, values.size()) {
    write(values);
  }
  Buffer(Device& device, const std::vector<T>& values)
      : Buffer(device, std::span<const T>(values)) {}

  /// Number of values, which may be less than the memory holds.
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }

  /// Keeps the first min(old, new) values; memory is replaced only when it must grow (then by at
  /// least a half), so set kernel arguments again afterwards.
  void resize(std::size_t size) {
    const std::size_t bytes = size * sizeof(T);
    if (bytes > raw_.capacity())
      raw_.reserve(std::max(bytes, raw_.capacity() + raw_.capacity() / 2), size_ * sizeof(T));
    size_ = size;
  }

  /// Copies `values` to offset `at` [values]. @throws DeviceError when they do not fit.
  void write(std::span<const T> values, std::size_t at = 0) {
    need(at, values.size());
    raw_.write(values.data(), at * sizeof(T), values.size() * sizeof(T));
  }
  /// The same without waiting: `values` must stay as they are until a later call has waited.
  void write_later(std::span<const T> values, std::size_t at = 0) {
    need(at, values.size());
    raw_.write(values.data(), at * sizeof(T), values.size() * sizeof(T), false);
  }
  /// Copies `values.size()` values from offset `at` [values] and waits. @throws DeviceError when
  /// they are not there.
  void read(std::span<T> values, std::size_t at = 0) const {
    need(at, values.size());
    raw_.read(values.data(), at * sizeof(T), values.size() * sizeof(T));
  }
  /// All values in a vector of their own: for tests and for what happens once.
  std::vector<T> read() const {
    std::vector<T> values(size_);
    read(values);
    return values;
  }
  /// Queues setting `count` values from `at` on (default: all) to `value`. Plain values of 1 to 128
  /// bytes that are a power of two long are filled by the device; others by the host, which waits.
  /// @throws DeviceError when the range is outside.
  void fill(const T& value, std::size_t at = 0, std::size_t count = npos) {
    if (count == npos) count = size_ - at;
    need(at, count);
    raw_.fill(&value, sizeof(T), at * sizeof(T), count * sizeof(T));
  }
  /// Queues a copy of `count` values of another buffer of the same device. The ranges are in
  /// values. @throws DeviceError when one of them is outside.
  void copy_from(const Buffer& other, std::size_t count, std::size_t from = 0, std::size_t to = 0) {
    other.need(from, count);
    need(to, count);
    raw_.copy_from(other.raw_, from * sizeof(T), to * sizeof(T), count * sizeof(T));
  }

  /// The values, to read. The range is `count` values from `at` on, by default all that follow.
  /// Waits for what was queued before. @throws DeviceError when the range is outside; so do the
  /// maps below.
  Mapped<const T> map_read(std::size_t at = 0, std::size_t count = npos) const {
    return mapped<const T>(RawBuffer::Access::kRead, at, count);
  }
  /// The same without waiting: the values are there once a later call has waited.
  Mapped<const T> map_read_later(std::size_t at = 0, std::size_t count = npos) const {
    return mapped<const T>(RawBuffer::Access::kRead, at, count, false);
  }
  /// The values, every one of which the caller will write; what they were is lost.
  Mapped<T> map_write(std::size_t at = 0, std::size_t count = npos) {
    return mapped<T>(RawBuffer::Access::kOverwrite, at, count);
  }
  /// The values, to read and change. Costs a copy both ways where memory is not shared.
  Mapped<T> map_update(std::size_t at = 0, std::size_t count = npos) {
    return mapped<T>(RawBuffer::Access::kUpdate, at, count);
  }

  /// For Kernel, which sets it as an argument.
  const RawBuffer& raw() const { return raw_; }

 private:
  static constexpr std::size_t npos = static_cast<std::size_t>(-1);
  // Written so that no sum can wrap around.
  void need(std::size_t at, std::size_t count) const {
    if (at > size_ || count > size_ - at) {
      throw DeviceError("buffer of " + std::to_string(size_) + " values: range " +
                        std::to_string(at) + " + " + std::to_string(count) + " is outside");
    }
  }
  // A range of nothing is not mapped, as OpenCL refuses one.
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
