// SPDX-License-Identifier: Apache-2.0
// What an OBJ file must hold before the library reads it.
#pragma once

#include <string>
#include <string_view>

namespace navvy::geometry {

/// The library takes words it cannot read for zeros, keeps no line numbers and reads without end,
/// so what must not pass is looked for before: broken numbers, indices of vertices, and more of
/// anything than core/limits.h allows.
/// @throws InputError naming file, line, value and rule.
void check_obj_lines(const std::string& path, std::string_view text);

/// Refuses a file: InputError with the rule and what to do. Line 0: the fault is not in one line.
[[noreturn]] void refuse_obj(const std::string& path, int line, std::string_view value,
                             const std::string& rule,
                             const std::string& remedy = "export the mesh again");

}  // namespace navvy::geometry
