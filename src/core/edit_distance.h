// SPDX-License-Identifier: Apache-2.0
// How unlike two words are, for "did you mean" in messages.
#pragma once

#include <cstddef>
#include <string>

namespace navvy {

/// Least number of insertions, removals and replacements of characters that turn a into b [Levenshtein 1966].
std::size_t edit_distance(const std::string& a, const std::string& b);

}  // namespace navvy
