// SPDX-License-Identifier: Apache-2.0
// Check of UTF-8 text, as JSON and CSV files require it.
#pragma once

#include <cstddef>
#include <string_view>

namespace navvy {

/// Returns the offset of the first byte that is not part of well-formed UTF-8 (RFC 3629: no
/// surrogates, no overlong forms, at most U+10FFFF), or npos if all of the text is valid.
std::size_t first_bad_utf8(std::string_view text);

}  // namespace navvy
