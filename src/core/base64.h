// SPDX-License-Identifier: Apache-2.0
// Encodes bytes as base64 text and decodes such text.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace navvy {

/// Returns `bytes` as base64 text with padding and without line breaks [RFC 4648]. The text has
/// four characters for each three bytes and fits into one line of JSON.
std::string base64(std::span<const std::byte> bytes);

/// Returns the bytes of a base64 text with padding and without line breaks [RFC 4648]; nothing if
/// the text is not of that form.
std::optional<std::string> base64_bytes(std::string_view text);

}  // namespace navvy
