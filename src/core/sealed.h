// SPDX-License-Identifier: Apache-2.0
// Checksums around the sections of a saved state: a file with a single wrong bit is refused before
// anything is read.
#pragma once

#include <string>
#include <vector>

namespace navvy {

/// Returns a saved state that consists of sections (core/saved_state.h) as the content of a file: a
/// head with its length, and a checksum for each outermost section that includes its position.
/// Costs a copy and one pass.
/// @throws Error for bytes outside of sections.
std::vector<char> seal(const std::vector<char>& state);

/// Returns the state inside a sealed content, after all checksums were verified in the order of the
/// file. Checksums do not protect against a deliberate change; the ranges of the fields do.
/// @throws InputError with the index and the name of the damaged section.
std::vector<char> unseal(const std::vector<char>& content);

/// Returns true if the regular file at `path` begins like a sealed state of any version, whatever
/// its name; false if the file is missing.
bool is_sealed(const std::string& path);

}  // namespace navvy
