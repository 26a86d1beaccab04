// SPDX-License-Identifier: Apache-2.0
// Checksums round the sections of a saved state: a file with one bit changed is refused before
// anything is read from it.
#pragma once

#include <string>
#include <vector>

namespace navvy {

/// A saved state (core/saved_state.h) that consists of sections, as the content of a file: a head
/// with its length, and a checksum for each of the outermost sections, which counts their order
/// too. Costs a copy and a pass.
/// @throws Error for bytes outside of sections.
std::vector<char> seal(const std::vector<char>& state);

/// The state again. Everything is checked before it returns, in the order of the file, so a damaged
/// one costs what lies before the damage. A checksum proves nothing against intent: whoever
/// recomputes it is met by the ranges of the fields.
/// @throws InputError that tells the damaged section by place and name.
std::vector<char> unseal(const std::vector<char>& content);

/// Whether the plain file `path` begins as a sealed state does, of any version: names are the
/// user's. False of what is not there.
bool is_sealed(const std::string& path);

}  // namespace navvy
