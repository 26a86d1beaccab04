// SPDX-License-Identifier: Apache-2.0
#include "scene_io/loader.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>

#include "scene_io/bucket_reader.h"
#include "scene_io/foreign.h"
#include "scene_io/machine_reader.h"
#include "scene_io/materials_reader.h"
#include "scene_io/overrides.h"
#include "scene_io/resolved.h"
#include "scene_io/soil_reader.h"
#include "scene_io/world_reader.h"

namespace navvy::scene_io {

namespace {

/// Returns a scene in which the machine of a file stands alone.
std::unique_ptr<Document> standing_alone(const std::string& file, const scene::Machine& machine,
                                         Faults& faults) {
  return Document::parse(scene_around(file, height_to_stand(machine)), file, faults);
}

/// Returns `document`, or a scene around it if it holds a machine alone.
std::unique_ptr<Document> with_world(std::unique_ptr<Document> document, Faults& faults) {
  const Element* root = document ? document->root() : nullptr;
  if (root == nullptr || root->FirstChildElement("world") != nullptr ||
      root->FirstChildElement("model") == nullptr)
    return document;
  // The faults of the machine are reported when the scene includes it.
  Faults unread;
  const scene::Machine machine = read_machine_file(document->file(), unread);
  return standing_alone(document->file(), machine, faults);
}

/// Reads a scene after its references and overrides.
scene::Scene read_scene(Document& document, const scene::StepKinds& kinds,
                        const Overrides& overrides, Faults& faults) {
  check_resolved(document, faults);
  // The same rules check the values of the file and of the command line.
  apply_overrides(document, overrides, faults);
  complete_world(document, faults);
  scene::Scene world = read_world(document, kinds, faults);
  warn_of_unused_seed(document, overrides, world, faults);
  return world;
}

/// Returns the scene in which the machine of a file stands alone; nothing if the overrides have
/// errors, which are added to `faults`. Those of the machine are there already.
std::optional<scene::Scene> scene_of_machine(const std::string& file, const scene::Machine& machine,
                                             const scene::StepKinds& kinds,
                                             const Overrides& overrides, Faults& faults) {
  Faults around;
  const std::unique_ptr<Document> document = standing_alone(file, machine, around);
  scene::Scene world;
  if (document) world = read_scene(*document, kinds, overrides, around);
  for (const Fault& fault : around.list())
    if (fault.severity == Fault::Severity::kError) faults.add(fault);
  if (around.has_errors()) return std::nullopt;
  return world;
}

scene::Scene load(std::unique_ptr<Document> document, const scene::StepKinds& kinds,
                  const Overrides& overrides, std::string* resolved, Faults& faults) {
  scene::Scene world;
  // Without a document, finish() throws the fault of opening it.
  document = with_world(std::move(document), faults);
  if (document) world = read_scene(*document, kinds, overrides, faults);
  faults.finish();
  // A faulty scene cannot be written out.
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

// A machine alone is checked as in a world.
scene::Machine load_machine(const std::string& file) {
  Faults faults;
  scene::Machine machine = read_machine_file(file, faults);
  faults.finish();
  return machine;
}

std::vector<scene::Soil> load_soils(const std::string& directory) {
  Faults faults;
  // Soils are numbered in this order, which must not depend on the file system.
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
  // All files are read, so that all faults are reported together.
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
  const auto result = [&] {
    if (count != nullptr) *count = {faults.error_count(), faults.warning_count()};
    return faults.list();
  };
  const auto document = Document::open(file, faults);
  if (!document) return result();
  const Element& root = *document->root();
  // The children of the root show the kind of file; without any of them the rules of scenes report
  // what is missing.
  if (!root.FirstChildElement("world") && root.FirstChildElement("navvy:soil")) {
    read_soil_file(file, faults);
  } else if (!root.FirstChildElement("world") && root.FirstChildElement("navvy:materials")) {
    scene::Materials table;
    read_materials_file(file, table, faults);
  } else if (!root.FirstChildElement("world") && root.FirstChildElement("navvy:bucket")) {
    check_bucket_file(*document, faults);
  } else if (!root.FirstChildElement("world") && root.FirstChildElement("model")) {
    scene::Machine read = read_machine_file(file, faults);
    if (world != nullptr && faults.error_count() == 0)
      *world = scene_of_machine(file, read, kinds, overrides, faults);
    if (machine != nullptr && faults.error_count() == 0) *machine = std::move(read);
  } else {
    scene::Scene read = read_scene(*document, kinds, overrides, faults);
    // Warnings do not prevent the use of a scene.
    if (world != nullptr && faults.error_count() == 0) *world = std::move(read);
  }
  return result();
}

}  // namespace navvy::scene_io
