// SPDX-License-Identifier: Apache-2.0
#include "sim/snapshot.h"

#include "core/error.h"
#include "core/file.h"
#include "heightfield/site.h"

namespace navvy::sim {
namespace {

constexpr std::uint32_t kVersion = 2;  // 2: samplers follow the coupling

}  // namespace

/// The head tells which scene and when, before anything that only a matching world can read.
void save_head(StateWriter& writer, const SnapshotHead& head) {
  writer.begin("world", kVersion);
  writer.text(head.scene);
  writer.value(head.dt);
  writer.value(head.steps);
  writer.end();
}

SnapshotHead load_head(StateReader& reader, const scene::World& scene) {
  // An unknown version is refused here by the reader, with both numbers in the message.
  reader.begin("world", kVersion);
  SnapshotHead head;
  head.scene = reader.text();
  head.dt = reader.value<double>();
  head.steps = reader.value<std::uint64_t>();
  reader.end();
  // A name is a weak key, yet it catches the slip that happens: the wrong file. The ground's own section checks its
  // size.
  if (head.scene != scene.name)
    throw InputError(Fault{Fault::Severity::kError, "snapshot", 0, "world", head.scene,
                           "the snapshot belongs to another scene than '" + scene.name + "'",
                           "load it into '" + head.scene + "' with the same solver settings"});
  return head;
}

heightfield::Ground load_ground(const scene::World& scene, const std::string& snapshot_file, SnapshotHead* head) {
  // Whole files: snapshots are read at once everywhere.
  StateReader reader(read_file(snapshot_file));
  try {
    const SnapshotHead found = load_head(reader, scene);
    if (head != nullptr) *head = found;
    // The ground's section comes first of all parts; what follows it needs a device and is left unread.
    heightfield::Ground ground = heightfield::make_ground(scene, nullptr);
    ground.load(reader);
    return ground;
  } catch (const InputError& error) {
    // Sections only know themselves; people need the file.
    Fault fault = error.faults().front();
    if (fault.file.empty() || fault.file == "snapshot") fault.file = snapshot_file;
    throw InputError(fault);
  }
}

}  // namespace navvy::sim
