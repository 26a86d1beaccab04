// SPDX-License-Identifier: Apache-2.0
// Edit distance of words, for "did you mean" in messages.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace navvy {

/// Returns the least number of insertions, deletions and substitutions of bytes that turn `a` into
/// `b` [Levenshtein 1966]. Costs the product of the lengths. A character outside ASCII counts as
/// several bytes.
std::size_t edit_distance(const std::string& a, const std::string& b);

/// Returns the name that is closest to `wanted`, the first one of equals, or an empty string if
/// `names` is empty. The caller decides whether the name is close enough to be worth suggesting.
std::string nearest_name(const std::vector<std::string>& names, const std::string& wanted);
/// Returns "did you mean 'x'?" with the candidate closest to `word`, or a list of all candidates if
/// none is close.
std::string suggestion(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace navvy
