// SPDX-License-Identifier: Apache-2.0
// What rigid bodies are made of, told by pairs: how two materials touch is a property of neither
// alone.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace navvy::scene {

/// How two materials touch, in either order.
struct MaterialPair {
  std::array<std::string, 2> materials;
  double static_friction = 0.8;   ///< tan of the steepest slope on which a body at rest stays [-]
  double kinetic_friction = 0.8;  ///< of sliding, at most the static one [-]
  double restitution = 0;         ///< speed of parting / speed of meeting, along the normal [-]
  /// How deep two bodies reach into each other by the force between them [m/N].
  double softness = 0;
};

/// The table of a scene. A link without a material touches by its own friction.
struct Materials {
  std::string ground;  ///< material of the ground; empty: none
  std::vector<MaterialPair> pairs;

  /// Null for a pair that is not in the table. The search is linear: names are resolved once.
  const MaterialPair* pair(const std::string& a, const std::string& b) const {
    for (const MaterialPair& each : pairs)
      if ((each.materials[0] == a && each.materials[1] == b) ||
          (each.materials[0] == b && each.materials[1] == a))
        return &each;
    return nullptr;
  }
};

/// The material of a link.
struct LinkMaterial {
  std::string name;  ///< empty: none
  int line = 0;      ///< of the machine's file, for messages
};

}  // namespace navvy::scene
