// SPDX-License-Identifier: Apache-2.0
// Checks the text of an OBJ file before the OBJ library reads it.
#pragma once

#include <string>
#include <string_view>

namespace navvy::geometry {

/// Checks the numbers, the vertex indices and the limits of core/limits.h in the text of an OBJ
/// file. `path` is used in messages. This is necessary because the library reads invalid words as
/// zero, reports no line numbers and has no limits.
/// @throws InputError naming file, line, value and rule
void check_obj_lines(const std::string& path, std::string_view text);

/// Reports an error in an OBJ file; never returns. Line 0 means that the error does not belong to
/// one line.
/// @throws InputError with the value, the rule and the remedy, always
[[noreturn]] void refuse_obj(const std::string& path, int line, std::string_view value,
                             const std::string& rule,
                             const std::string& remedy = "export the mesh again");

}  // namespace navvy::geometry
