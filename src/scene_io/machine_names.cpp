// SPDX-License-Identifier: Apache-2.0
#include "scene_io/machine_names.h"

#include <algorithm>

namespace navvy::scene_io {

Names names_of(const Element& model) {
  Names names;
  for (const Element* e = model.FirstChildElement(); e; e = e->NextSiblingElement()) {
    const std::string kind = e->Name(), name = attribute(*e, "name");
    if (kind == "link") names.links.push_back(name);
    if (kind == "frame") names.frames.push_back(name);
    if (kind == "navvy:shell") names.shells.push_back(name);
    if (kind == "joint") {
      names.joints.push_back(name);
      names.joint_type[name] = attribute(*e, "type");
    }
  }
  return names;
}

namespace {
bool contains(const std::vector<std::string>& list, const std::string& name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}
}  // namespace

void require_name(const Element& element, const char* child_name, const char* what,
                  const std::vector<std::string>& names, Faults& faults) {
  const Element* child = element.FirstChildElement(child_name);
  if (!child || text_of(*child).empty() || contains(names, text_of(*child))) return;
  faults.error(*child, text_of(*child), std::string("no ") + what + " of this name in the model",
               faults.nearest(text_of(*child), names));
}

void require_attribute_name(const Element& element, Faults& faults) {
  if (attribute(element, "name").empty())
    faults.error(element, "", "needs an attribute name=\"...\"");
}

}  // namespace navvy::scene_io
