// SPDX-License-Identifier: Apache-2.0
// Error messages for names and indices that do not exist.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace navvy::sim {

/// Throws an InputError which says that there is no part of type `kind` ("joint", "machine") called
/// `name`, and which suggests the most similar name in `known`.
[[noreturn]] void throw_unknown(const std::string& kind, const std::string& name,
                                const std::vector<std::string>& known);

/// Checks that `index` is in the range 0 to `count` - 1. `kind` is the type of the indexed parts
/// for the message: "joint", "machine".
/// @throws InputError if the index is out of range.
void require_index(const std::string& kind, int index, std::size_t count);

/// Returns the index of the first entry in `list` for which `key(entry)` equals `name`. `kind` is
/// the type of the entries for the message: "joint", "machine".
/// @throws InputError if there is no such entry; the message suggests the most similar name.
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
