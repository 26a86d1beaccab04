// SPDX-License-Identifier: Apache-2.0
#include "sim/snapshot.h"

#include <utility>

#include "core/error.h"
#include "core/file.h"
#include "core/hash.h"
#include "core/log.h"
#include "core/saved_state.h"
#include "core/sealed.h"
#include "heightfield/make_ground.h"

namespace navvy::sim {
namespace {

/// A name is a weak key, yet it catches the slip that happens: the wrong file.
void require_scene(Archive& a, const std::string& scene) {
  std::string found = scene;
  // Runs of one scene cannot differ in it, so it would tell a hash nothing.
  a.unhashed("", [&] { a("scene", found); });
  if (a.loading() && found != scene)
    throw InputError(Fault{
        Fault::Severity::kError, "snapshot", 0, "scene", found,
        "it was taken of this scene, and the one to go on in is '" + scene + "'",
        "go on in the scene it was taken of; --resume-anyway lets parameters of one scene differ, "
        "and no more"});
}

}  // namespace

void SnapshotHead::visit(Archive& a) {
  // Version 2: samplers follow the coupling; 3: one visit drives hash, save and load.
  a.section("world", 3, [&] {
    // The ground's own section checks its size.
    require_scene(a, scene);
    a("dt", dt);
    // Thirty years of steps: counts of periods, which are as many or a million times more, are
    // still whole numbers.
    a.ranged("steps", steps, 0, 1'000'000'000'000);
  });
}

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

void SnapshotStart::visit(Archive& a) {
  a.section("start", 1, [&] {
    // First, as two scenes differ in everything: their names say more than a list.
    require_scene(a, scene);
    scene::Parameters found = here;
    a("parameters", found);
    if (!a.loading() || found == here) return;
    const std::string differences = scene::differences(found, here);
    if (!anyway)
      throw InputError(Fault{
          Fault::Severity::kError, "snapshot", 0, "start", "",
          "it was taken of a scene that differs: " + differences,
          "name the scene it was taken of; `navvy run` goes on in this one with --resume-anyway"});
    log_warning("going on from a snapshot of another scene: " + differences);
  });
}

namespace {

/// The ground's section comes first of all parts; what follows it needs a device and is left
/// unread.
struct Front {
  SnapshotStart start;
  SnapshotHead head;
  heightfield::Ground ground;

  void visit(Archive& a) {
    a("start", start);
    a("head", head);
    a("ground", ground);
  }
};

}  // namespace

heightfield::Ground load_ground(const scene::Scene& scene, const std::string& snapshot_file,
                                SnapshotHead* head) {
  try {
    heightfield::Ground ground = heightfield::make_ground(scene, nullptr);
    Front front{{start_of(scene, ground), scene.name}, {scene.name}, std::move(ground)};
    // Whole files: snapshots are read at once everywhere.
    load_front(unseal(read_file(snapshot_file)), front);
    if (head != nullptr) *head = front.head;
    return std::move(front.ground);
  } catch (const InputError& error) {
    // Sections only know themselves; people need the file.
    Fault fault = error.faults().front();
    if (fault.file.empty() || fault.file == "snapshot") fault.file = snapshot_file;
    throw InputError(fault);
  }
}

}  // namespace navvy::sim
