// SPDX-License-Identifier: Apache-2.0
// How unlike two words are, for "did you mean" in messages.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace navvy {

/// Least number of insertions, removals and replacements of characters that turn a into b [Levenshtein 1966].
std::size_t edit_distance(const std::string& a, const std::string& b);

/// The one of `names` most like `wanted`, the first of equals; empty without names.
std::string nearest_name(const std::vector<std::string>& names, const std::string& wanted);

}  // namespace navvy
