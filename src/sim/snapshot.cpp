// SPDX-License-Identifier: Apache-2.0
#include "sim/snapshot.h"

#include <utility>

#include "core/error.h"
#include "core/hash.h"
#include "core/log.h"
#include "core/saved_state.h"

namespace navvy::sim {
namespace {

/// A name is a weak key, but it detects the usual mistake: the wrong file.
void require_scene(Archive& a, const std::string& scene) {
  std::string found = scene;
  // Equal for all runs of one scene, so it adds nothing to a hash.
  a.unhashed("", [&] { a("scene", found); });
  if (a.loading() && found != scene)
    throw InputError(Fault{Fault::Severity::kError, "snapshot", 0, "scene", found,
                           "the snapshot is of this scene, but the run's scene is '" + scene + "'",
                           "resume the scene it was taken from; --resume-anyway allows other "
                           "parameters, not another scene"});
}

}  // namespace

// Bounds keep time, steps x dt, a number that can be counted.
void SnapshotHead::visit(Archive& a) {
  // Version 2: samplers follow the coupling; 3: one visit drives hash, save and load.
  a.section("world", 3, [&] {
    // The ground's own section checks its size.
    require_scene(a, scene);
    a("dt", dt);
    // Thirty years of steps. Counts of periods, which are up to a million times more, are still
    // whole numbers.
    a.ranged("steps", steps, 0, 1'000'000'000'000);
  });
}

// The hash of a map stands for its heights, since the scene names only the file.
scene::Parameters start_of(const scene::Scene& scene, const heightfield::Ground& ground) {
  scene::Parameters out = scene::parameters(scene);
  if (ground.setup().map_hash != 0) {
    StateHash sum;
    sum.value(ground.setup().map_hash);
    out["ground/map"] = sum.hex();
  }
  return out;
}

std::uint64_t hash_of_start(const scene::Parameters& start) {
  StateHash sum;
  for (const auto& [path, value] : start) {
    sum.bytes(path.data(), path.size());
    sum.bytes(value.data(), value.size());
  }
  return sum.digest();
}

// Compares parameter by parameter, so that the message can list the differences.
void SnapshotStart::visit(Archive& a) {
  a.section("start", 1, [&] {
    // First: if the scenes differ, their names say more than a list of parameters.
    require_scene(a, scene);
    scene::Parameters found = here;
    a("parameters", found);
    if (!a.loading() || found == here) return;
    const std::string differences = scene::differences(found, here);
    if (!anyway)
      throw InputError(
          Fault{Fault::Severity::kError, "snapshot", 0, "start", "",
                "the scene's parameters differ from the snapshot's: " + differences,
                "resume the scene it was taken from, or pass --resume-anyway to `navvy run`"});
    log_warning("resuming although the scene's parameters differ from the snapshot's: " +
                differences);
  });
}

}  // namespace navvy::sim
