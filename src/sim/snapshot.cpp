// SPDX-License-Identifier: Apache-2.0
#include "sim/snapshot.h"

#include <utility>

#include "core/error.h"
#include "core/file.h"
#include "core/saved_state.h"
#include "heightfield/site.h"

namespace navvy::sim {

void SnapshotHead::visit(Archive& a) {
  // Version 2: samplers follow the coupling; 3: one visit drives hash, save and load.
  a.section("world", 3, [&] {
    // A name is a weak key, yet it catches the slip that happens: the wrong file. The ground's own section checks its
    // size.
    a.constant("scene", scene,
               "the snapshot belongs to another scene than '" + scene +
                   "'; load it into its own scene with the same solver settings");
    a("dt", dt);
    a("steps", steps);
  });
}

namespace {

/// The ground's section comes first of all parts; what follows it needs a device and is left unread.
struct Front {
  SnapshotHead head;
  heightfield::Ground ground;

  void visit(Archive& a) {
    a("head", head);
    a("ground", ground);
  }
};

}  // namespace

heightfield::Ground load_ground(const scene::Scene& scene, const std::string& snapshot_file, SnapshotHead* head) {
  try {
    Front front{{scene.name}, heightfield::make_ground(scene, nullptr)};
    // Whole files: snapshots are read at once everywhere.
    load_front(read_file(snapshot_file), front);
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
