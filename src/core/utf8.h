// SPDX-License-Identifier: Apache-2.0
// Check for valid UTF-8 text, which JSON and CSV files require.
#pragma once

#include <cstddef>
#include <string_view>

namespace navvy {

/// Returns the offset of the first byte in `text` that does not belong to well-formed UTF-8 (RFC
/// 3629: no surrogates, no overlong forms, at most U+10FFFF); npos if the whole text is
/// well-formed.
std::size_t first_bad_utf8(std::string_view text);

}  // namespace navvy
