// SPDX-License-Identifier: Apache-2.0
// Bytes as text.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace navvy::link {

/// Returns `bytes` in base64 with padding and without line ends [RFC 4648]: four characters for
/// each three bytes, so a picture or an array fits into one line of JSON.
std::string base64(std::span<const std::byte> bytes);

}  // namespace navvy::link
