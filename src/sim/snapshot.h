// SPDX-License-Identifier: Apache-2.0
// Parts of a snapshot that can be read without running its world.
#pragma once

#include <cstdint>
#include <string>

#include "core/archive.h"
#include "heightfield/layered_ground.h"
#include "scene/parameters.h"
#include "scene/scene.h"

namespace navvy::sim {

/// First section of a world's snapshot: scene and time, before anything that only a matching world
/// can read.
struct SnapshotHead {
  /// Name of its scene.
  std::string scene;
  /// Base step [s].
  double dt = 0;
  /// Steps taken. Time [s] is steps x dt.
  std::uint64_t steps = 0;

  /// Visits the head. @throws InputError for a snapshot of a scene with a name other than `scene`.
  void visit(Archive& a);
};

/// Returns everything that determines a run of `scene`: its parameters and the heights of the map
/// it starts on. A snapshot file stores all of it before the state.
scene::Parameters start_of(const scene::Scene& scene, const heightfield::Ground& ground);
/// Returns the hash of a start. It is part of every state hash, so two runs that differ in a
/// parameter never have the same hash.
std::uint64_t hash_of_start(const scene::Parameters& start);

/// Section of a snapshot file with the start of the run it was taken from.
struct SnapshotStart {
  /// Start of the scene that it is loaded into, or saved from.
  scene::Parameters here;
  /// Name of that scene.
  std::string scene;
  /// Load the state even if the starts differ, and log the differences.
  bool anyway = false;

  /// Visits the start. @throws InputError that lists the differences, unless `anyway`; always for a
  /// scene with another name.
  void visit(Archive& a);
};

}  // namespace navvy::sim
