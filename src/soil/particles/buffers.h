// SPDX-License-Identifier: Apache-2.0
// Device buffers that grow with what they hold.
#pragma once

#include <algorithm>
#include <vector>

#include "device/buffer.h"

namespace navvy::soil {

/// Makes room for `size` values and keeps those that stand there; never shrinks.
template <class T>
void fit(device::Device& device, device::Buffer<T>& buffer, std::size_t size) {
  if (buffer.empty()) {
    buffer = device::Buffer<T>(device, std::max<std::size_t>(size, 1));
  } else if (buffer.size() < size) {
    buffer.resize(size + size / 2);
  }
}

/// Makes room for `size` values, contents undefined: set kernel arguments again afterwards.
template <class T>
void ensure(device::Device& device, device::Buffer<T>& buffer, std::size_t size) {
  if (buffer.size() < size || buffer.empty())
    buffer = device::Buffer<T>(device, size + size / 2 + 1);
}

/// The same, then writes the values; waits.
template <class T>
void upload(device::Device& device, device::Buffer<T>& buffer, const std::vector<T>& values) {
  ensure(device, buffer, values.size());
  buffer.write(values);
}

}  // namespace navvy::soil
