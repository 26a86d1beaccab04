// SPDX-License-Identifier: Apache-2.0
// Coupling of two machines of a world.
#pragma once

#include <string>

#include "scene/fields.h"

namespace navvy::scene {

/// A ball joint between two machines that can be opened and closed: an eye on the child machine is
/// held in a hook on the parent machine. A ball joint within one machine's file, in contrast,
/// cannot be opened.
struct Hitch {
  std::string name;  ///< unique name of the hitch
  /// Links with the hook and with the eye, as the file writes them: MACHINE::LINK.
  std::string parent_name, child_name;
  /// Indices in Scene::machines of the parent machine and of the child machine.
  int parent = 0, child = 0;
  int parent_link = 0, child_link = 0;  ///< indices of the links in their machine's `links`
  /// Position of the hook in the frame of the parent link, and of the eye in the frame of the child
  /// link [m].
  Vec3 hook = Vec3::Zero(), eye = Vec3::Zero();
  /// Limits of the closed hitch [rad]; pi: unlimited. `cone` is the maximum angle between the x
  /// axes of both links, `twist` the maximum rotation of the child about its x axis in either
  /// direction.
  double cone = kPi, twist = kPi;
  bool closed = true;  ///< state at the start: true if the eye is held in the hook
  int line = 0;        ///< line of the hitch in the scene file, for messages

  /// Passes the fields of a <navvy:hitch> to the visitor `f`.
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
