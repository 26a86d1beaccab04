// SPDX-License-Identifier: Apache-2.0
// How unlike two words are, for "did you mean" in messages.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace navvy {

/// Least number of insertions, removals and replacements of characters that turn a into b
/// [Levenshtein 1966]. Costs the product of the lengths. Bytes are compared, not letters: a name
/// outside ASCII is a little further away than it looks.
std::size_t edit_distance(const std::string& a, const std::string& b);

/// The one of `names` most like `wanted`, the first of equals; empty without names. It answers
/// however unlike the two are: whether the name is worth telling is for the caller to say.
std::string nearest_name(const std::vector<std::string>& names, const std::string& wanted);
/// The candidate most like `word` as "did you mean 'x'?", or a list of all when nothing is near.
std::string suggestion(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace navvy
