// SPDX-License-Identifier: Apache-2.0
// Materials of rigid bodies. Friction and rebound are properties of pairs of materials.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/limits.h"
#include "scene/fields.h"

namespace navvy::scene {

/// Contact properties of two materials. The order of the two does not matter.
struct MaterialPair {
  std::array<std::string, 2> materials;
  double static_friction = 0.8;
  double kinetic_friction = 0.8;
  double restitution = 0;
  double softness = 0;
  /// Both names as the file writes them, separated by a blank.
  std::string names;

  void describe(Fields& f) {
    f.attribute("materials", names, "The two materials, separated by a blank, in either order.");
    f("static_friction", static_friction, {0, 5},
      "Tangent of the steepest slope on which a body stays at rest.", kNeeded);
    f("kinetic_friction", kinetic_friction, {0, 5},
      "Coefficient of sliding friction, at most the static one, which is its default.");
    f("restitution", restitution, {0, 1}, "Normal speed of separation / normal speed of approach.");
    f("softness_m_per_n", softness, {0, 0.01}, "Penetration depth / contact force; 0: rigid.");
  }
};

/// Contact properties by pairs of materials. A link without a material uses its collision shapes'
/// own friction coefficients.
struct Materials {
  std::string file;
  /// Material of the ground; empty if it has none.
  std::string ground;
  std::vector<MaterialPair> pairs;

  void describe(Fields& f) {
    f("file", file,
      "Table of pairs: a file beside the scene or a shipped one (`materials.sdf`: steel, stone, "
      "rubber, earth).",
      kShown);
    f("ground", ground, "Material of the ground.");
    f("pair", pairs, limits::kMaterialPairs, "Contact properties of two materials.");
  }
  /// Returns the properties of materials `a` and `b`; null if the table has no such pair. The
  /// search is linear.
  const MaterialPair* pair(const std::string& a, const std::string& b) const {
    for (const MaterialPair& each : pairs)
      if ((each.materials[0] == a && each.materials[1] == b) ||
          (each.materials[0] == b && each.materials[1] == a))
        return &each;
    return nullptr;
  }
};

/// Material of a link, and where the machine's file names it.
struct LinkMaterial {
  /// Name of the material; empty if the link has none.
  std::string name;
  /// Line of the <navvy:material> in the machine's file, for messages.
  int line = 0;
};

}  // namespace navvy::scene
