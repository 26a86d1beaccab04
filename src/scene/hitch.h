// SPDX-License-Identifier: Apache-2.0
// What couples two machines of a world.
#pragma once

#include <string>

#include "core/math.h"

namespace navvy::scene {

/// A ball joint between two machines that can be opened and closed: the eye of the one in the hook
/// of the other. A joint inside of a machine's file stays.
struct Hitch {
  std::string name;
  // Machines by their index in the scene, links by theirs in the machine.
  int parent = 0, child = 0;
  int parent_link = 0, child_link = 0;
  Vec3 hook = Vec3::Zero(), eye = Vec3::Zero();  ///< in the parent's and the child's link [m]
  /// How far [rad] the x axes of both links may lean from each other, and the child turn about them
  /// either way.
  double cone = kPi, twist = kPi;
  bool closed = true;  ///< at the start
  int line = 0;        ///< of the scene's file, for messages
};

}  // namespace navvy::scene
