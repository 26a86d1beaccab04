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

/// Untyped memory behind Buffer; sizes and offsets in bytes.
class RawBuffer {
 public:
  RawBuffer() = default;
  RawBuffer(Device& device, std::size_t bytes);
  /// Makes room for `bytes`, keeping the first `keep` of them.
  void reserve(std::size_t bytes, std::size_t keep);
  void write(const void* data, std::size_t offset, std::size_t bytes, bool wait = true);
  void read(void* data, std::size_t offset, std::size_t bytes) const;
  void copy_from(const RawBuffer& other, std::size_t from, std::size_t to, std::size_t bytes);
  void fill(const void* pattern, std::size_t pattern_bytes, std::size_t offset, std::size_t bytes);
  enum class Access { kRead, kOverwrite, kUpdate };
  void* map(Access access, std::size_t offset, std::size_t bytes, bool wait = true) const;
  void unmap(void* at) const noexcept;
  std::size_t capacity() const { return capacity_; }
  void* handle() const;  ///< the cl_mem

 private:
  struct Memory;
  std::shared_ptr<Memory> memory_;
  std::size_t capacity_ = 0;
};

/// A mapped range of a buffer; unmaps when it goes. The buffer must outlive it, and no kernel may use the buffer
/// meanwhile.
template <class T>
class Mapped {
 public:
  Mapped(const RawBuffer* buffer, T* data, std::size_t size) : buffer_(buffer), view_(data, size) {}
  Mapped(Mapped&& other) noexcept : buffer_(std::exchange(other.buffer_, nullptr)), view_(other.view_) {}
  Mapped(const Mapped&) = delete;
  Mapped& operator=(const Mapped&) = delete;
  Mapped& operator=(Mapped&&) = delete;
  ~Mapped() {
    if (buffer_ != nullptr && !view_.empty()) buffer_->unmap(const_cast<std::remove_const_t<T>*>(view_.data()));
  }
  std::span<T> span() const { return view_; }
  T* data() const { return view_.data(); }
  std::size_t size() const { return view_.size(); }
  T& operator[](std::size_t i) const { return view_[i]; }
  T* begin() const { return view_.data(); }
  T* end() const { return view_.data() + view_.size(); }

 private:
  const RawBuffer* buffer_;
  std::span<T> view_;
};

/// `size()` values of T on one device, zero-copy when the device shares the host's memory.
///
/// New memory is not initialised. An empty buffer is allowed and can be a kernel's argument. Moving is cheap, copying
/// is not offered. `write`, `read` and maps wait for what was queued before; `fill`, `copy_from`, `resize` and
/// what is called `..._later` do not wait.
template <class T>
class Buffer {
  static_assert(std::is_trivially_copyable_v<T>, "device memory holds plain values");

 public:
  Buffer() = default;
  Buffer(Device& device, std::size_t size) : raw_(device, size * sizeof(T)), size_(size) {}
  Buffer(Device& device, std::span<const T> values) : Buffer(device, values.size()) { write(values); }
  Buffer(Device& device, const std::vector<T>& values) : Buffer(device, std::span<const T>(values)) {}

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }

  /// Keeps the first min(old, new) values; memory is replaced only when it must grow (then by at least a half), so set
  /// kernel arguments again afterwards.
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
  void read(std::span<T> values, std::size_t at = 0) const {
    need(at, values.size());
    raw_.read(values.data(), at * sizeof(T), values.size() * sizeof(T));
  }
  std::vector<T> read() const {
    std::vector<T> values(size_);
    read(values);
    return values;
  }
  /// Queues setting `count` values from `at` on (default: all) to `value`.
  void fill(const T& value, std::size_t at = 0, std::size_t count = npos) {
    if (count == npos) count = size_ - at;
    need(at, count);
    raw_.fill(&value, sizeof(T), at * sizeof(T), count * sizeof(T));
  }
  /// Queues a copy of `count` values of another buffer of the same device.
  void copy_from(const Buffer& other, std::size_t count, std::size_t from = 0, std::size_t to = 0) {
    other.need(from, count);
    need(to, count);
    raw_.copy_from(other.raw_, from * sizeof(T), to * sizeof(T), count * sizeof(T));
  }

  /// The values, to read.
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
  /// The values, to read and change.
  Mapped<T> map_update(std::size_t at = 0, std::size_t count = npos) {
    return mapped<T>(RawBuffer::Access::kUpdate, at, count);
  }

  const RawBuffer& raw() const { return raw_; }

 private:
  static constexpr std::size_t npos = static_cast<std::size_t>(-1);
  void need(std::size_t at, std::size_t count) const {
    if (at > size_ || count > size_ - at) {
      throw DeviceError("buffer of " + std::to_string(size_) + " values: range " + std::to_string(at) + " + " +
                        std::to_string(count) + " is outside");
    }
  }
  template <class U>
  Mapped<U> mapped(RawBuffer::Access access, std::size_t at, std::size_t count, bool wait = true) const {
    if (count == npos) count = at <= size_ ? size_ - at : 0;
    need(at, count);
    void* data = count == 0 ? nullptr : raw_.map(access, at * sizeof(T), count * sizeof(T), wait);
    return Mapped<U>(&raw_, static_cast<U*>(data), count);
  }
  RawBuffer raw_;
  std::size_t size_ = 0;
};

}  // namespace navvy::device
