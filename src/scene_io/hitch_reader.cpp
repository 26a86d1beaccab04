// SPDX-License-Identifier: Apache-2.0
#include "scene_io/hitch_reader.h"

#include <string>
#include <vector>

#include "scene_io/fields.h"
#include "scene_io/xml_limits.h"

namespace navvy::scene_io {

namespace {

/// One end: the machine and link that `at` names. False after a fault, or for a machine that could
/// not be read.
bool find_end(const Element& at, const scene::Scene& world, int& machine, int& link,
              Faults& faults) {
  const std::string text = text_of(at);
  // Machines and links may both have names of several parts.
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
    faults.error(at, text, "a hitch joins machines that forces move, and this one moves as told",
                 "set <navvy:engine>dynamic</navvy:engine>");
    return false;
  }
  link = built.link_index(text.substr(cut + 2));
  if (link >= 0) return true;
  for (const scene::Link& one : built.links) names.push_back(text.substr(0, cut + 2) + one.name);
  faults.error(at, text, "no link of this name in the machine", faults.nearest(text, names));
  return false;
}

scene::Hitch read_hitch(Element& element, const scene::Scene& world, Faults& faults) {
  scene::Hitch hitch;
  hitch.name = attribute(element, "name");
  hitch.line = element.GetLineNum();
  std::string parent, child;
  Fields fields(element, faults);
  fields.attribute("name")
      .text("parent", parent)
      .required("parent")
      .text("child", child)
      .required("child")
      .vec3("hook_m", hitch.hook)
      .required("hook_m")
      .vec3("eye_m", hitch.eye)
      .required("eye_m")
      .number("cone_deg", hitch.cone, {0.1, 180}, kDegree)
      .number("twist_deg", hitch.twist, {0.1, 180}, kDegree)
      .flag("closed", hitch.closed)
      .finish();
  if (hitch.name.empty())
    faults.error(element, "", "needs an attribute name=\"...\"",
                 "its input is called CHILD/NAME/closed");
  else
    check_name(element, hitch.name, faults);
  if (parent.empty() || child.empty()) return hitch;
  const Element& at_child = *fields.child("child");
  const bool known =
      find_end(*fields.child("parent"), world, hitch.parent, hitch.parent_link, faults);
  if (!find_end(at_child, world, hitch.child, hitch.child_link, faults) || !known) return hitch;
  if (hitch.parent == hitch.child)
    faults.error(at_child, child, "a machine cannot hang on itself",
                 "name a link of another machine");
  for (const scene::Hitch& other : world.hitches)
    if (other.child == hitch.child)
      faults.error(at_child, child, "this machine hangs on hitch '" + other.name + "' already",
                   "name it as the <parent> of one of them");
  return hitch;
}

}  // namespace

void read_hitches(Element& world_element, scene::Scene& world, Faults& faults) {
  for (Element* e = world_element.FirstChildElement("navvy:hitch"); e;
       e = e->NextSiblingElement("navvy:hitch")) {
    const std::size_t before = faults.error_count();
    scene::Hitch hitch = read_hitch(*e, world, faults);
    for (const scene::Hitch& other : world.hitches)
      if (!hitch.name.empty() && other.name == hitch.name)
        faults.error(*e, hitch.name, "there is already a hitch of this name", "rename one of them");
    // What has a fault is told of once, and no other is held against it.
    if (faults.error_count() == before) world.hitches.push_back(std::move(hitch));
  }
}

}  // namespace navvy::scene_io
