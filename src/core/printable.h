// SPDX-License-Identifier: Apache-2.0
// Text of unknown origin (names, paths, values, messages of libraries) made safe to print.
#pragma once

#include <string>
#include <string_view>

namespace navvy {

/// Returns `text` as one line of well-formed UTF-8 that a terminal only displays. Each control
/// character (C0, DEL, C1), line separator, direction mark (bidi) and invisible character is
/// replaced by its escape, such as `\x1B` or `\u202E`, and so is each byte that is not part of
/// well-formed UTF-8. All other characters stay as they are, backslashes too, so the result is for
/// people and cannot be decoded.
std::string printable(std::string_view text);
/// Returns `text` as `printable` does, but keeps line ends and tabs: for messages of several lines,
/// such as the log of a compiler.
std::string printable_lines(std::string_view text);

}  // namespace navvy
