// SPDX-License-Identifier: Apache-2.0
#include "core/edit_distance.h"

#include <algorithm>
#include <numeric>

namespace navvy {

std::size_t edit_distance(const std::string& a, const std::string& b) {
  // One row of the table at a time: an entry depends on the row above and on its left neighbour
  // only. Memory is that of the second word, time the product of both lengths.
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    // The entry of the row above at j - 1, which a substitution builds on, saved before it is
    // overwritten.
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t keep = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({keep, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row.back();
}

namespace {

/// Returns the words of a name ("sand_dry" or "sand-dry"), sorted and joined by blanks.
std::string sorted_words(const std::string& name) {
  std::vector<std::string> words(1);
  for (const char c : name) {
    if (c == '_' || c == '-' || c == ' ')
      words.emplace_back();
    else
      words.back() += c;
  }
  std::sort(words.begin(), words.end());
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : " ") + word;
  return out;
}

/// Returns the edit distance, where words in another order ("dry_sand" for "sand_dry") count as one
/// edit.
std::size_t unlikeness(const std::string& a, const std::string& b) {
  return std::min(edit_distance(a, b), 1 + edit_distance(sorted_words(a), sorted_words(b)));
}

}  // namespace

std::string nearest_name(const std::vector<std::string>& names, const std::string& wanted) {
  std::string nearest;
  std::size_t least = static_cast<std::size_t>(-1);
  for (const std::string& name : names) {
    const std::size_t distance = unlikeness(name, wanted);
    // Strictly less: the first of equals wins, so a message does not depend on the order of a set.
    if (distance < least) least = distance, nearest = name;
  }
  return nearest;
}

std::string suggestion(const std::string& word, const std::vector<std::string>& candidates) {
  if (candidates.empty()) return "remove it";
  // Long words come from broken files; their distance is useless and slow to compute.
  const std::string head = word.substr(0, 64);
  const std::string* best = nullptr;
  // A candidate is near if at most half of the word, or two characters, have to change.
  std::size_t least = std::max<std::size_t>(2, head.size() / 2) + 1;
  for (const std::string& candidate : candidates) {
    std::size_t distance = unlikeness(head, candidate);
    // A forgotten unit ("cohesion" for "cohesion_pa") is the most likely mistake.
    if (!head.empty() && candidate.rfind(head, 0) == 0) distance = 0;
    if (distance < least) {
      least = distance;
      best = &candidate;
    }
  }
  if (best) return "did you mean '" + *best + "'?";
  std::string all = "known here: ";
  for (std::size_t i = 0; i < candidates.size(); ++i) all += (i ? ", " : "") + candidates[i];
  return all;
}

}  // namespace navvy
