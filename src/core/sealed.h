// SPDX-License-Identifier: Apache-2.0
// Files with saved states. Checksums protect the sections of the state: a file with even one wrong
// bit is refused before any field is loaded.
#pragma once

#include <string>
#include <vector>

namespace navvy {

/// Returns the content of a file for a saved state that consists of sections (core/saved_state.h).
/// The content has a head with its length, and a checksum before each outermost section, which also
/// covers the position of the section and the checksum before it; the head holds the last one. So
/// all sections belong to one state. This takes one copy and one pass over the state.
/// @throws Error if bytes of the state do not belong to a section
std::vector<char> seal(const std::vector<char>& state);

/// Returns the saved state in the content of a file, after checking all checksums in the order of
/// the file. Checksums do not protect against deliberate changes; the checks on loading fields do.
/// @throws InputError with the 1-based position and the name of the damaged section
std::vector<char> unseal(const std::vector<char>& content);

/// Returns true if the regular file at `path` begins like a file with a saved state, of any version
/// and whatever its name; false for other files and if it does not exist.
bool is_sealed(const std::string& path);

}  // namespace navvy
