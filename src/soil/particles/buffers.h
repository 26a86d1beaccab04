// SPDX-License-Identifier: Apache-2.0
// Device buffers that grow with their contents.
#pragma once

#include <algorithm>
#include <vector>

#include "device/buffer.h"

namespace navvy::soil {

/// Grows a buffer to at least `size` values and keeps its contents; never shrinks it.
///
/// Growing costs a copy on the device; half as much memory again is allocated to make it rare.
template <class T>
void fit(device::Device& device, device::Buffer<T>& buffer, std::size_t size) {
  if (buffer.empty()) {
    buffer = device::Buffer<T>(device, std::max<std::size_t>(size, 1));
  } else if (buffer.size() < size) {
    buffer.resize(size + size / 2);
  }
}

/// Grows a buffer to at least `size` values with undefined contents. Kernel arguments must be set
/// again afterwards.
///
/// Use it for arrays that a kernel rewrites as a whole.
template <class T>
void ensure(device::Device& device, device::Buffer<T>& buffer, std::size_t size) {
  if (buffer.size() < size || buffer.empty())
    buffer = device::Buffer<T>(device, size + size / 2 + 1);
}

/// Grows a buffer if needed and writes the values; waits.
///
/// Use it for lists that the host computes when blocks change, not for data of every step.
template <class T>
void upload(device::Device& device, device::Buffer<T>& buffer, const std::vector<T>& values) {
  ensure(device, buffer, values.size());
  buffer.write(values);
}

}  // namespace navvy::soil
