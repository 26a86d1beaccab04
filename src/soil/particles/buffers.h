// SPDX-License-Identifier: Apache-2.0
// Device buffers that grow with their contents.
#pragma once

#include <algorithm>
#include <vector>

#include "device/buffer.h"

namespace navvy::soil {

/// Grows a buffer to at least `size` values and preserves its contents; never shrinks it.
///
/// Growing copies the contents on the device. To make that rare, half as much memory again is
/// allocated.
template <class T>
void fit(device::Device& device, device::Buffer<T>& buffer, std::size_t size) {
  if (buffer.empty()) {
    buffer = device::Buffer<T>(device, std::max<std::size_t>(size, 1));
  } else if (buffer.size() < size) {
    buffer.resize(size + size / 2);
  }
}

/// Grows a buffer to at least `size` values; the contents are undefined afterwards. If the buffer
/// was reallocated, kernel arguments that refer to it must be set again.
///
/// Use it for arrays that a kernel rewrites completely.
template <class T>
void ensure(device::Device& device, device::Buffer<T>& buffer, std::size_t size) {
  if (buffer.size() < size || buffer.empty())
    buffer = device::Buffer<T>(device, size + size / 2 + 1);
}

/// Grows a buffer if needed and writes all `values` to it; waits for the copy.
///
/// Use it for lists that the host computes when blocks change, not for data that changes in every
/// step.
template <class T>
void upload(device::Device& device, device::Buffer<T>& buffer, const std::vector<T>& values) {
  ensure(device, buffer, values.size());
  buffer.write(values);
}

}  // namespace navvy::soil
