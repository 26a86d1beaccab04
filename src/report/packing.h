// SPDX-License-Identifier: Apache-2.0
// Compressed values in a page.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace navvy::report {

/// Returns bytes compressed by gzip as base64 text, which a browser can unpack; "" for no bytes.
std::string packed_bytes(std::span<const std::byte> bytes);

/// Returns values, little-endian, as `packed_bytes` does.
template <class T>
std::string packed(const std::vector<T>& values) {
  return packed_bytes(std::as_bytes(std::span(values)));
}

}  // namespace navvy::report
