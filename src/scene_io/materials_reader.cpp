// SPDX-License-Identifier: Apache-2.0
#include "scene_io/materials_reader.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>

#include "scene_io/element_reader.h"
#include "scene_io/loader.h"
#include "scene_io/mesh_path.h"
#include "scene_io/sdf_rules.h"

namespace navvy::scene_io {
namespace {

/// Adds the pairs of a table to `into`, whose own pairs were read before.
void take_pairs(Element& table, std::vector<scene::MaterialPair> pairs, scene::Materials& into,
                Faults& faults) {
  const std::vector<Element*> elements = children_of(table, {"pair"});
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    scene::MaterialPair& pair = pairs[i];
    const Element& element = *elements.at(i);
    const std::vector<std::string> words = words_of(pair.names);
    if (words.size() != 2) {
      faults.error(element, pair.names, "a pair has two materials",
                   "e.g. materials=\"steel stone\"");
      continue;
    }
    pair.materials = {words[0], words[1]};
    const Element* kinetic = element.FirstChildElement("kinetic_friction");
    // Without a value of its own, sliding friction equals friction at rest.
    if (kinetic == nullptr) pair.kinetic_friction = pair.static_friction;
    if (kinetic != nullptr && pair.kinetic_friction > pair.static_friction)
      faults.error(*kinetic, text_of(*kinetic),
                   "must not exceed static_friction: friction at rest is the greater one",
                   "exchange the two, or remove kinetic_friction if both are the same");
    // `pair` finds both orders of the names.
    if (into.pair(words[0], words[1]) != nullptr)
      faults.error(element, pair.names, "this pair is in the table already",
                   "remove one of them; the order of names is free");
    else
      into.pairs.push_back(std::move(pair));
  }
}

/// Returns the names in a table, each once.
std::vector<std::string> known_in(const scene::Materials& table) {
  std::set<std::string> names;
  for (const scene::MaterialPair& pair : table.pairs)
    names.insert(pair.materials.begin(), pair.materials.end());
  return {names.begin(), names.end()};
}

/// Use of a material by links of a machine.
struct Use {
  std::size_t machine;
  const scene::LinkMaterial* material;
  bool stands;  ///< never moves, so it meets neither the ground nor others that stand
};

// Documents of machine files are closed by now, so file and line come from the structs.
Fault at_use(const scene::Scene& world, const Use& use, const std::string& rule,
             const std::string& remedy) {
  const scene::MachineInWorld& placed = world.machines[use.machine];
  return {Fault::Severity::kError,
          placed.machine.file.empty() ? world.file : placed.machine.file,
          use.material->line,
          "model[" + placed.machine.name + "]/link/navvy:material",
          use.material->name,
          rule,
          remedy};
}

}  // namespace

std::string materials_file(const Element& file) {
  std::error_code ignored;
  // A file beside the scene wins over a shipped table of the same name.
  const std::filesystem::path path =
      std::filesystem::path(Document::of(file).directory()) / text_of(file);
  if (std::filesystem::is_regular_file(path, ignored)) return path.string();
  return text_of(file).find('/') == std::string::npos ? find_data("terrain/" + text_of(file)) : "";
}

void read_materials_file(const std::string& file, scene::Materials& into, Faults& faults) {
  const auto document = Document::open(file, faults);
  if (!document || !check_root(*document->root(), faults)) return;
  check_sdf(*document->root(), faults);
  Element* table = document->root()->FirstChildElement("navvy:materials");
  if (table == nullptr) {
    faults.error(*document->root(), "", "a table of materials needs <navvy:materials>");
    return;
  }
  scene::Materials read;
  read_element(*table, read, nullptr, faults);
  // A table refers to no other one, so there are no loops.
  for (const char* name : {"file", "ground"})
    if (const Element* child = table->FirstChildElement(name))
      faults.error(*child, text_of(*child), "unknown element", "only a scene's own table has it");
  take_pairs(*table, std::move(read.pairs), into, faults);
}

scene::Materials read_materials(Element& element, Faults& faults) {
  scene::Materials read, out;
  read_element(element, read, nullptr, faults);
  out.ground = read.ground;
  out.file = read.file;
  // The file first, so that a second entry of a pair is reported in the scene.
  if (const Element* child = element.FirstChildElement("file"); child && !read.file.empty()) {
    if (const std::string path = materials_file(*child); !path.empty())
      read_materials_file(path, out, faults);
    else
      faults.error(*child, read.file, why_no_file(read.file),
                   "paths count from the scene file; a bare name may be a shipped table, such as "
                   "materials.sdf");
  }
  take_pairs(element, std::move(read.pairs), out, faults);
  if (!out.ground.empty()) {
    const Element& at = child_or_self(element, "ground");
    const std::vector<std::string> known = known_in(out);
    if (std::find(known.begin(), known.end(), out.ground) == known.end())
      faults.error(at, out.ground, "no pair has this material", faults.nearest(out.ground, known));
  }
  return out;
}

void check_materials(const scene::Scene& world, Faults& faults) {
  const std::vector<std::string> known = known_in(world.materials);
  // Links of one machine never meet each other, so one use per machine and material is enough.
  std::vector<Use> uses;  // one per machine and material
  for (std::size_t m = 0; m < world.machines.size(); ++m) {
    const scene::Machine& machine = world.machines[m].machine;
    std::set<std::pair<std::string, bool>> seen;
    for (std::size_t l = 0; l < machine.links.size(); ++l) {
      const scene::LinkMaterial& material = machine.links[l].material;
      // Kinematic machines meet neither the ground nor each other.
      const bool stands = machine.kinematic || (l == 0 && machine.fixed_base);
      if (!material.name.empty() && seen.emplace(material.name, stands).second)
        uses.push_back({m, &material, stands});
    }
  }
  // A set makes the order of a pair irrelevant. A set of one name is an unknown material or the
  // pair of a material with itself; one name is never both.
  std::set<std::set<std::string>> reported;
  for (const Use& use : uses) {
    const std::string& name = use.material->name;
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      if (reported.insert({name}).second)
        faults.add(at_use(world, use, "no pair of the scene's <navvy:materials> has this material",
                          faults.nearest(name, known)));
      continue;
    }
    const auto look = [&](const std::string& other) {
      // An unknown other name is reported at its own use.
      const bool both_known = std::find(known.begin(), known.end(), other) != known.end();
      if (!both_known || world.materials.pair(name, other) != nullptr ||
          !reported.insert({name, other}).second)
        return;
      faults.add(at_use(
          world, use, "touches '" + other + "', and the scene's <navvy:materials> has no such pair",
          "add <pair materials=\"" + name + " " + other + "\">"));
    };
    if (!use.stands && !world.materials.ground.empty()) look(world.materials.ground);
    for (const Use& other : uses)
      if (other.machine != use.machine && !(use.stands && other.stands)) look(other.material->name);
  }
}

}  // namespace navvy::scene_io
