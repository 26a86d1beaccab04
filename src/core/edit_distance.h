// SPDX-License-Identifier: Apache-2.0
// Edit distance between words, for suggestions in error messages.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace navvy {

/// Returns the minimum number of insertions, deletions and substitutions of bytes that turn `a`
/// into `b` [Levenshtein 1966]. The cost is proportional to the product of both lengths. A
/// character outside ASCII counts as several bytes.
std::size_t edit_distance(const std::string& a, const std::string& b);

/// Returns the entry of `names` that is most similar to `wanted`; the first one if several are
/// equally similar, and an empty text if `names` is empty. The caller decides whether it is similar
/// enough to be suggested.
std::string nearest_name(const std::vector<std::string>& names, const std::string& wanted);
/// Returns "did you mean 'x'?" with the candidate that is most similar to `word`; a list of all
/// candidates if none is similar; "remove it" if there are no candidates.
std::string suggestion(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace navvy
