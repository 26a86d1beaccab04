// SPDX-License-Identifier: Apache-2.0
// Parts of a snapshot (a saved world) that can be read before a matching world is built.
#pragma once

#include <cstdint>
#include <string>

#include "core/archive.h"
#include "heightfield/layered_ground.h"
#include "scene/parameters.h"
#include "scene/scene.h"

namespace navvy::sim {

/// First section of a world's snapshot: the scene's name and the simulated time. It can be read
/// without a matching world.
struct SnapshotHead {
  /// Name of the scene that the snapshot was taken from. When loading, set it to the name of the
  /// scene to load into.
  std::string scene;
  /// Length of the base step [s].
  double dt = 0;
  /// Number of base steps taken. The simulated time [s] is steps x dt.
  std::uint64_t steps = 0;

  /// Visits the head, to hash, save or load it.
  /// @throws InputError when loading the snapshot of a scene whose name is not `scene`.
  void visit(Archive& a);
};

/// Returns everything that determines a run of `scene`, by name: the parameters of the scene and,
/// if `ground` was built from a map, the hash of its heights. A snapshot file stores all of it
/// before the state.
scene::Parameters start_of(const scene::Scene& scene, const heightfield::Ground& ground);
/// Returns the hash of a start, as start_of returns it. Every state hash includes this hash, so two
/// runs with different parameters have different state hashes.
std::uint64_t hash_of_start(const scene::Parameters& start);

/// Section of a snapshot file that holds the start (parameters and map hash) of the run that the
/// snapshot was taken from.
struct SnapshotStart {
  /// Start of the scene that is saved, or that the snapshot is loaded into.
  scene::Parameters here;
  /// Name of the scene that is saved, or that the snapshot is loaded into.
  std::string scene;
  /// If true, a snapshot with a different start is loaded all the same, and the differences are
  /// logged as a warning.
  bool anyway = false;

  /// Visits the start, to save or load it.
  /// @throws InputError when loading a snapshot of a scene with another name, or one whose start
  /// differs; the message lists the differences. `anyway` allows a different start, but not another
  /// name.
  void visit(Archive& a);
};

}  // namespace navvy::sim
