// SPDX-License-Identifier: Apache-2.0
// Error messages for names and indices that do not exist.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace navvy::sim {

/// Throws InputError: there is no `kind` called `name`; did you mean the nearest of `known`?
[[noreturn]] void throw_unknown(const std::string& kind, const std::string& name,
                                const std::vector<std::string>& known);

/// @throws InputError if `index` is not in 0 .. count - 1. `kind` names what is counted.
void require_index(const std::string& kind, int index, std::size_t count);

/// Returns the index in `list` of the entry whose `key(entry)` is `name`. `kind` is the word for
/// the message: "joint", "machine".
/// @throws InputError as throw_unknown.
template <class List, class Key>
int index_of(const std::string& kind, const List& list, const std::string& name, Key&& key) {
  for (std::size_t i = 0; i < list.size(); ++i)
    if (key(list[i]) == name) return static_cast<int>(i);
  std::vector<std::string> known;
  known.reserve(list.size());
  for (const auto& entry : list) known.push_back(key(entry));
  throw_unknown(kind, name, known);
}

}  // namespace navvy::sim
