// SPDX-License-Identifier: Apache-2.0
// Encodes bytes as base64 text.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace navvy::link {

/// Returns `bytes` as base64 text with padding and without line breaks [RFC 4648]. The text has
/// four characters for each three bytes and fits into one line of JSON.
std::string base64(std::span<const std::byte> bytes);

}  // namespace navvy::link
