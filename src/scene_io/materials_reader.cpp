// SPDX-License-Identifier: Apache-2.0
#include "scene_io/materials_reader.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>

#include "scene_io/fields.h"
#include "scene_io/loader.h"
#include "scene_io/mesh_path.h"
#include "scene_io/sdf_rules.h"

namespace navvy::scene_io {
namespace {

void read_pair(Element& element, scene::Materials& into, Faults& faults) {
  scene::MaterialPair pair;
  const std::string names = attribute(element, "materials");
  const std::vector<std::string> words = words_of(names);
  Fields fields(element, faults);
  fields.attribute("materials")
      .number("static_friction", pair.static_friction, {0, 5})
      .required("static_friction")
      .number("kinetic_friction", pair.kinetic_friction, {0, 5})
      .number("restitution", pair.restitution, {0, 1})
      .number("softness_m_per_n", pair.softness, {0, 0.01})
      .finish();
  if (words.size() != 2) {
    faults.error(element, names, "a pair has two materials", "e.g. materials=\"steel stone\"");
    return;
  }
  pair.materials = {words[0], words[1]};
  // One number serves for both.
  if (const Element* kinetic = fields.child("kinetic_friction")) {
    if (pair.kinetic_friction > pair.static_friction)
      faults.error(*kinetic, text_of(*kinetic),
                   "must not exceed static_friction: what rests holds at least as well",
                   "exchange the two, or leave kinetic_friction out where both are the same");
  } else {
    pair.kinetic_friction = pair.static_friction;
  }
  if (into.pair(words[0], words[1]) != nullptr) {
    faults.error(element, names, "this pair is in the table already",
                 "remove one of them; the order of names is free");
    return;
  }
  into.pairs.push_back(std::move(pair));
}

/// Names in the table, each once.
std::vector<std::string> known_in(const scene::Materials& table) {
  std::set<std::string> names;
  for (const scene::MaterialPair& pair : table.pairs)
    names.insert(pair.materials.begin(), pair.materials.end());
  return {names.begin(), names.end()};
}

/// A material that some link of a machine has.
struct Use {
  std::size_t machine;
  const scene::LinkMaterial* material;
  bool stands;  ///< what never moves meets neither the ground nor what stands beside it
};

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
  // Tables must not refer to others: no loops to follow.
  Fields(*table, faults)
      .each("pair", [&](Element& pair) { read_pair(pair, into, faults); })
      .finish();
}

scene::Materials read_materials(Element& element, Faults& faults) {
  scene::Materials out;
  std::string file;
  Fields fields(element, faults);
  fields.text("file", file).text("ground", out.ground).each("pair", [](Element&) {}).finish();
  // The file first: what stands in the scene is blamed for a pair that is told twice.
  if (const Element* child = fields.child("file"); child != nullptr && !file.empty()) {
    if (const std::string path = materials_file(*child); !path.empty())
      read_materials_file(path, out, faults);
    else
      faults.error(*child, file, why_no_file(file),
                   "paths count from the scene file; a bare name may be a shipped table, such as "
                   "materials.sdf");
  }
  for (Element* pair = element.FirstChildElement("pair"); pair;
       pair = pair->NextSiblingElement("pair"))
    read_pair(*pair, out, faults);
  const std::vector<std::string> known = known_in(out);
  if (!out.ground.empty() && std::find(known.begin(), known.end(), out.ground) == known.end())
    faults.error(*fields.child("ground"), out.ground, "no pair has this material",
                 faults.nearest(out.ground, known));
  return out;
}

void check_materials(const scene::Scene& world, Faults& faults) {
  const std::vector<std::string> known = known_in(world.materials);
  std::vector<Use> uses;  // the first of each machine's links of a material
  for (std::size_t m = 0; m < world.machines.size(); ++m) {
    const scene::Machine& machine = world.machines[m].machine;
    std::set<std::pair<std::string, bool>> seen;
    for (std::size_t l = 0; l < machine.links.size(); ++l) {
      const scene::LinkMaterial& material = machine.links[l].material;
      // Machines that move as told do not meet the ground, nor each other.
      const bool stands = machine.kinematic || (l == 0 && machine.fixed_base);
      if (!material.name.empty() && seen.emplace(material.name, stands).second)
        uses.push_back({m, &material, stands});
    }
  }
  std::set<std::set<std::string>> told;
  for (const Use& use : uses) {
    const std::string& name = use.material->name;
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      if (told.insert({name}).second)
        faults.add(at_use(world, use, "no pair of the scene's <navvy:materials> has this material",
                          faults.nearest(name, known)));
      continue;
    }
    const auto look = [&](const std::string& other) {
      const bool both_known = std::find(known.begin(), known.end(), other) != known.end();
      if (!both_known || world.materials.pair(name, other) != nullptr ||
          !told.insert({name, other}).second)
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
