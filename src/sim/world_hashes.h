// SPDX-License-Identifier: Apache-2.0
// Hashes of a world's state.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace navvy::sim {

struct WorldParts;

/// Computes hashes of a world's state, to compare two runs.
///
/// An object of this class is a pointer to its world: it is cheap to copy and valid as long as the
/// world exists.
class WorldHashes {
 public:
  /// Creates an object for the world that owns `parts`. Clients call World::hashes instead.
  explicit WorldHashes(const WorldParts& parts) : parts_(&parts) {}

  /// Returns the hash of what the run started from (World::start): all scene parameters and the
  /// heights of the map.
  std::uint64_t start() const;
  /// Returns the hash of the world's current state and of what the run started from [hex]. Costs a
  /// pass over the whole state.
  std::string state() const;
  /// Returns pairs of name and hash [hex]: first for what the run started from, then for every part
  /// of the current state. The parts come in the order in which a change spreads between them
  /// within a step, so in a comparison of two runs the first part that differs shows where they
  /// diverged. Costs a pass over the whole state.
  std::vector<std::pair<std::string, std::string>> parts() const;

 private:
  const WorldParts* parts_;
};

}  // namespace navvy::sim
