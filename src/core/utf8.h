// SPDX-License-Identifier: Apache-2.0
// Whether bytes are text. What is written as JSON and CSV must be.
#pragma once

#include <cstddef>
#include <string_view>

namespace navvy {

/// The place of the first byte that is not part of well-formed UTF-8 (RFC 3629: no surrogates,
/// nothing overlong, at most U+10FFFF); npos for good text.
std::size_t first_bad_utf8(std::string_view text);

}  // namespace navvy
