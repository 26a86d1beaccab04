// SPDX-License-Identifier: Apache-2.0
// Hashes of a world's state.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace navvy::sim {

struct WorldParts;

/// Hashes a world, to compare two runs.
///
/// A view of one pointer: copy it freely. Valid as long as its world lives.
class WorldHashes {
 public:
  /// Refers to the parts of a world; World::hashes makes it.
  explicit WorldHashes(const WorldParts& parts) : parts_(&parts) {}

  /// Returns the hash of World::start: every parameter of the scene and the heights of its map.
  std::uint64_t start() const;
  /// Returns the hash of state and start [hex]. Costs a pass over the state.
  std::string state() const;
  /// Returns name and hash [hex] of the start and of every part, in the order in which a change
  /// reaches them within a step. The first difference between two runs shows where they diverge.
  std::vector<std::pair<std::string, std::string>> parts() const;

 private:
  const WorldParts* parts_;
};

}  // namespace navvy::sim
