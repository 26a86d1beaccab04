// SPDX-License-Identifier: Apache-2.0
// What of a snapshot can be read without running the world it is of.
#pragma once

#include <cstdint>
#include <string>

#include "core/archive.h"
#include "heightfield/layered_ground.h"
#include "scene/parameters.h"
#include "scene/scene.h"

namespace navvy::sim {

/// The first section of a world's snapshot. It tells which scene and when, before anything that
/// only a matching world can read.
struct SnapshotHead {
  std::string scene;        ///< name of the scene it is of
  double dt = 0;            ///< base step [s]
  std::uint64_t steps = 0;  ///< time [s] is steps x dt

  /// Refuses a snapshot of a scene with another name than `scene`.
  void visit(Archive& a);
};

/// Everything that decides how a run of `scene` goes: its parameters, and the heights of the map it
/// starts on. The whole of it stands in a snapshot's file, before the state.
scene::Parameters start_of(const scene::Scene& scene, const heightfield::Ground& ground);
/// Hash of that, which is part of every hash of a state: two runs that start alike and differ in a
/// parameter never have one hash.
std::uint64_t hash_of_start(const scene::Parameters& start);

/// The section of a snapshot's file that holds the start of the run it was taken of.
struct SnapshotStart {
  scene::Parameters here;  ///< of the scene that it is loaded into, or saved from
  std::string scene;       ///< its name
  /// A difference is told in the log, and the state is loaded all the same.
  bool anyway = false;

  /// @throws InputError that says what differs, unless `anyway`; for a scene with another name
  /// always.
  void visit(Archive& a);
};

/// The ground as it lay when the snapshot was taken: columns alone, without the soil that was
/// awake. `scene` is the one that ran (a run's folder holds it as scene.sdf). Needs no OpenCL
/// device; reads a heightmap that the scene names. `head` receives the time of the snapshot when it
/// is given.
/// @throws FileError when the file cannot be read, InputError when it does not fit the scene; the
/// message names it.
heightfield::Ground load_ground(const scene::Scene& scene, const std::string& snapshot_file,
                                SnapshotHead* head = nullptr);

}  // namespace navvy::sim
