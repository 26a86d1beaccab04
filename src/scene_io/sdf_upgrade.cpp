// SPDX-License-Identifier: Apache-2.0
// Brings SDF files of versions 1.3 to 1.6 and 1.10 to 1.12 to 1.9.
#include <cstring>
#include <set>

#include "scene_io/element_reader.h"
#include "scene_io/foreign_private.h"

namespace navvy::scene_io {

namespace {

/// Rules that differ between the versions before 1.7 and 1.9.
struct OldRules {
  bool axis_in_model = false;  ///< true: by default an axis is given in the frame of its model
};

/// Gives the axis of a joint the frame in which its file means it.
void upgrade_axis(Element& axis, const OldRules& rules) {
  bool in_model = rules.axis_in_model;
  if (Element* use = axis.FirstChildElement("use_parent_model_frame")) {
    in_model = is_true(text_of(*use));
    axis.DeleteChild(use);
  }
  Element* xyz = axis.FirstChildElement("xyz");
  if (in_model && xyz != nullptr && xyz->Attribute("expressed_in") == nullptr)
    xyz->SetAttribute("expressed_in", "__model__");
}

void upgrade_old(Element& element, const OldRules& rules) {
  const char* name = element.Name();
  if (std::strcmp(name, "pose") == 0) {
    const std::string frame = attribute(element, "frame");
    element.DeleteAttribute("frame");
    if (!frame.empty()) element.SetAttribute("relative_to", frame.c_str());
  } else if (std::strcmp(name, "axis") == 0 || std::strcmp(name, "axis2") == 0) {
    upgrade_axis(element, rules);
  } else if (std::strcmp(name, "plugin") != 0) {
    for (Element* e = element.FirstChildElement(); e; e = e->NextSiblingElement())
      upgrade_old(*e, rules);
  }
}

}  // namespace

void upgrade_sdf(Document& document) {
  Element& root = *document.root();
  const std::string version = attribute(root, "version");
  static const std::set<std::string> old = {"1.3", "1.4", "1.5", "1.6"};
  static const std::set<std::string> later = {"1.10", "1.11", "1.12"};
  if (old.count(version) == 0 && later.count(version) == 0) return;
  // From 1.5 on an axis is in the frame of its joint unless the file says otherwise.
  if (old.count(version) > 0) upgrade_old(root, {version == "1.3" || version == "1.4"});
  root.SetAttribute("version", "1.9");
}

}  // namespace navvy::scene_io
