// SPDX-License-Identifier: Apache-2.0
// Coupling of two machines of a world.
#pragma once

#include <string>

#include "scene/fields.h"

namespace navvy::scene {

/// A ball joint between two machines that can be opened and closed: the hook of the parent holds
/// the eye of the child. (Joints inside a machine cannot be opened.)
struct Hitch {
  std::string name;
  /// Names of the two links as MACHINE::LINK, as the file gives them.
  std::string parent_name, child_name;
  /// Indices of the two machines in Scene::machines.
  int parent = 0, child = 0;
  /// Indices of the two links in their machines.
  int parent_link = 0, child_link = 0;
  /// Positions of hook and eye, each in the frame of its link [m].
  Vec3 hook = Vec3::Zero(), eye = Vec3::Zero();
  /// Limits of the joint's rotation [rad]; pi means no limit.
  double cone = kPi, twist = kPi;
  bool closed = true;
  /// Line of the <navvy:hitch> in the scene file, for messages.
  int line = 0;

  void describe(Fields& f) {
    f.attribute("name", name, "Name of the hitch; its input is CHILD/NAME/closed.", kNeeded);
    f("parent", parent_name, "Link with the hook, as MACHINE::LINK; of a dynamic machine.",
      kNeeded | kShown);
    f("child", child_name, "Link with the eye, as MACHINE::LINK; of another dynamic machine.",
      kNeeded | kShown);
    f("hook_m", hook, "Hook in the frame of the parent link.", kNeeded);
    f("eye_m", eye,
      "Eye in the frame of the child link; at most 0.1 m from the hook if the hitch starts closed.",
      kNeeded);
    f("cone_deg", cone, {0.1, 180}, "Largest angle between the x axes of both links.");
    f("twist_deg", twist, {0.1, 180}, "Largest turn of the child about its x axis, either way.");
    f("closed", closed, "State at the start.");
    f.derived("parent_machine", parent);
    f.derived("child_machine", child);
    f.derived("parent_link", parent_link);
    f.derived("child_link", child_link);
  }
};

}  // namespace navvy::scene
