// SPDX-License-Identifier: Apache-2.0
#include "scene_io/loader.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "scene_io/machine_reader.h"
#include "scene_io/materials_reader.h"
#include "scene_io/overrides.h"
#include "scene_io/resolved.h"
#include "scene_io/soil_reader.h"
#include "scene_io/world_reader.h"

namespace navvy::scene_io {

namespace {

scene::Scene load(std::unique_ptr<Document> document, const scene::StepKinds& kinds,
                  const Overrides& overrides, std::string* resolved, Faults& faults) {
  scene::Scene world;
  // Without a document there is nothing to read, and finish() throws what opening it has found.
  if (document) {
    check_resolved(*document, faults);
    // Overrides go into the document first, so that one set of rules checks the file's values and
    // the command line's.
    apply_overrides(*document, overrides, faults);
    world = read_world(*document, kinds, faults);
    warn_of_unused_seed(*document, overrides, world, faults);
  }
  faults.finish();
  // Only now: what has a fault cannot be written out.
  if (document && resolved != nullptr) *resolved = resolved_text(*document, world);
  return world;
}

}  // namespace

scene::Scene load_scene(const std::string& file, const scene::StepKinds& kinds,
                        const Overrides& overrides, std::string* resolved) {
  Faults faults;
  return load(Document::open(file, faults), kinds, overrides, resolved, faults);
}

scene::Scene load_scene_from_string(const std::string& text, const std::string& name,
                                    const scene::StepKinds& kinds, const Overrides& overrides,
                                    std::string* resolved) {
  Faults faults;
  return load(Document::parse(text, name, faults), kinds, overrides, resolved, faults);
}

// Machines are checked alone as they are in a world, so a fault in one is found without a scene.
scene::Machine load_machine(const std::string& file) {
  Faults faults;
  scene::Machine machine = read_machine_file(file, faults);
  faults.finish();
  return machine;
}

std::vector<scene::Soil> load_soils(const std::string& directory) {
  Faults faults;
  // Sorted, as a directory's own order differs between file systems and soils are numbered by it.
  std::vector<std::string> files;
  std::error_code failed;
  for (const auto& entry : std::filesystem::directory_iterator(directory, failed))
    if (entry.path().extension() == ".sdf") files.push_back(entry.path().string());
  if (failed) {
    Fault fault;
    fault.file = directory;
    fault.rule = "the directory cannot be read: " + failed.message();
    faults.add(fault);
  }
  std::sort(files.begin(), files.end());
  std::vector<scene::Soil> soils;
  // Files after one with a fault are read, too: all faults come together.
  for (const std::string& file : files)
    for (scene::Soil& soil : read_soil_file(file, faults)) soils.push_back(std::move(soil));
  faults.finish();
  return soils;
}

std::vector<Fault> check(const std::string& file, const scene::StepKinds& kinds,
                         std::optional<scene::Scene>* world, const Overrides& overrides,
                         std::optional<scene::Machine>* machine, FaultCount* count) {
  Faults faults;
  if (world != nullptr) world->reset();
  if (machine != nullptr) machine->reset();
  const auto told = [&] {
    if (count != nullptr) *count = {faults.error_count(), faults.warning_count()};
    return faults.list();
  };
  const auto document = Document::open(file, faults);
  if (!document) return told();
  const Element& root = *document->root();
  // What the file is follows from what its root holds; a scene is assumed where nothing fits, so
  // that its rules say what is missing.
  if (!root.FirstChildElement("world") && root.FirstChildElement("navvy:soil")) {
    read_soil_file(file, faults);
  } else if (!root.FirstChildElement("world") && root.FirstChildElement("navvy:materials")) {
    scene::Materials table;
    read_materials_file(file, table, faults);
  } else if (!root.FirstChildElement("world") && root.FirstChildElement("model")) {
    scene::Machine read = read_machine_file(file, faults);
    if (machine != nullptr && faults.error_count() == 0) *machine = std::move(read);
  } else {
    check_resolved(*document, faults);
    apply_overrides(*document, overrides, faults);
    scene::Scene read = read_world(*document, kinds, faults);
    warn_of_unused_seed(*document, overrides, read, faults);
    // Warnings do not keep a scene from being used.
    if (world != nullptr && faults.error_count() == 0) *world = std::move(read);
  }
  return told();
}

}  // namespace navvy::scene_io
