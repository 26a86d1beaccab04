// SPDX-License-Identifier: Apache-2.0
// Checks that a class hashes what it saves: every saved byte is flipped in turn.
#pragma once

#include <string>
#include <vector>

#include "core/error.h"
#include "core/saved_state.h"

namespace navvy::test {

/// Flips every byte of `object`'s saved state and returns the faults, one line per field; empty if
/// there are none. In runs of more than `long_run` bytes every `stride`-th byte is flipped: a
/// stride without a common factor with the size of an element reaches all of its bytes. In shorter
/// ones the first and then every `short_stride`-th.
///
/// A flipped state must be refused, or change the hash of `target` that loads it, or be in a field
/// whose visit gives a reason for not being hashed. `target` is loaded repeatedly and must be
/// created like `object` (same scene).
template <class T>
std::string flip_every_byte(const T& object, T& target, std::size_t stride = 1,
                            std::size_t short_stride = 1, std::size_t long_run = 256) {
  ByteMap map;
  const std::vector<char> bytes = saved(object, &map);
  const std::uint64_t hash = hash_of(object).digest();
  std::string report, last;
  const auto note_fault = [&](const std::string& path, const char* what) {
    if (path != last) report += path + ": " + what + "\n";
    last = path;
  };
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const ByteMap::Field* field = map.at(i);
    if (field && (i - field->offset) % (field->size > long_run ? stride : short_stride) != 0)
      continue;
    std::vector<char> flipped = bytes;
    // Flips the lowest bit: a bool stays one, and a number changes least.
    flipped[i] = static_cast<char>(flipped[i] ^ 1);
    try {
      load_saved(flipped, target);
    } catch (const InputError&) {
      continue;
    }
    if (!field) {
      note_fault("byte " + std::to_string(i), "is in no field and loads when flipped");
    } else if (!field->hashed) {
      if (field->reason.empty()) note_fault(field->path, "differs from the scene and loads");
    } else if (hash_of(target).digest() == hash) {
      note_fault(field->path, "is saved but not hashed");
    }
  }
  return report;
}

}  // namespace navvy::test
