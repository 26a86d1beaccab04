// SPDX-License-Identifier: Apache-2.0
#include "scene_io/hitch_reader.h"

#include <string>
#include <vector>

#include "scene_io/element_reader.h"

namespace navvy::scene_io {

namespace {

/// Finds the machine and link that `at` names. Returns false after a fault, or if the machine could
/// not be read.
bool find_end(const Element& at, const scene::Scene& world, int& machine, int& link,
              Faults& faults) {
  const std::string text = text_of(at);
  // Names of machines and links may contain "::" themselves.
  std::size_t cut = text.find("::");
  for (; cut != std::string::npos; cut = text.find("::", cut + 2))
    if (world.machine_index(text.substr(0, cut)) >= 0) break;
  machine = world.machine_index(text.substr(0, cut));
  std::vector<std::string> names;
  if (machine < 0 || cut == std::string::npos) {
    for (const scene::MachineInWorld& placed : world.machines)
      for (const scene::Link& one : placed.machine.links)
        names.push_back(placed.name + "::" + one.name);
    faults.error(at, text, "must be MACHINE::LINK of this world", faults.nearest(text, names));
    return false;
  }
  const scene::Machine& built = world.machines[static_cast<std::size_t>(machine)].machine;
  if (built.links.empty()) return false;
  if (built.kinematic) {
    faults.error(at, text, "a hitch joins dynamic machines, and this one is kinematic",
                 "set <navvy:physics>dynamic</navvy:physics>");
    return false;
  }
  link = built.link_index(text.substr(cut + 2));
  if (link >= 0) return true;
  for (const scene::Link& one : built.links) names.push_back(text.substr(0, cut + 2) + one.name);
  return require_name(at, text, "link of this name in the machine", names, faults);
}

void finish_hitch(const Element& element, scene::Hitch& hitch, const scene::Scene& world,
                  Faults& faults) {
  if (hitch.parent_name.empty() || hitch.child_name.empty()) return;
  const Element& at_parent = child_or_self(element, "parent");
  const Element& at_child = child_or_self(element, "child");
  // Both ends are looked up before returning, so that both faults are reported.
  const bool known = find_end(at_parent, world, hitch.parent, hitch.parent_link, faults);
  if (!find_end(at_child, world, hitch.child, hitch.child_link, faults) || !known) return;
  if (hitch.parent == hitch.child)
    faults.error(at_child, hitch.child_name, "a machine cannot be hitched to itself",
                 "name a link of another machine");
  for (const scene::Hitch& other : world.hitches)
    if (other.child == hitch.child)
      faults.error(at_child, hitch.child_name,
                   "this machine is the child of hitch '" + other.name + "' already",
                   "name it as the <parent> of one of them");
}

}  // namespace

void read_hitches(Element& world_element, scene::Scene& world, Faults& faults) {
  for (Element* e : children_of(world_element, {"navvy:hitch"})) {
    const std::size_t before = faults.error_count();
    scene::Hitch hitch;
    hitch.line = e->GetLineNum();
    read_element(*e, hitch, nullptr, faults);
    finish_hitch(*e, hitch, world, faults);
    for (const scene::Hitch& other : world.hitches)
      if (!hitch.name.empty() && other.name == hitch.name)
        faults.error(*e, hitch.name, "there is already a hitch of this name", "rename one of them");
    // Later hitches are not compared with a faulty one.
    if (faults.error_count() == before) world.hitches.push_back(std::move(hitch));
  }
}

}  // namespace navvy::scene_io
