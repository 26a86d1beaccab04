// SPDX-License-Identifier: Apache-2.0
// Check of an OBJ file before the library reads it.
#pragma once

#include <string>
#include <string_view>

namespace navvy::geometry {

/// Checks the numbers, the vertex indices and the limits of core/limits.h in the text of an OBJ
/// file. The library reads invalid words as zero, reports no line numbers and has no limits, so the
/// check comes first.
/// @throws InputError naming file, line, value and rule.
void check_obj_lines(const std::string& path, std::string_view text);

/// Refuses a file. Line 0 means that the fault is not in one line.
/// @throws InputError with the rule and the remedy, always.
[[noreturn]] void refuse_obj(const std::string& path, int line, std::string_view value,
                             const std::string& rule,
                             const std::string& remedy = "export the mesh again");

}  // namespace navvy::geometry
