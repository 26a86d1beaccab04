// SPDX-License-Identifier: Apache-2.0
// Materials of rigid bodies. Friction and restitution are properties of pairs of materials.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/limits.h"
#include "scene/fields.h"

namespace navvy::scene {

/// Contact properties of two materials. The order of the two materials has no meaning.
struct MaterialPair {
  std::array<std::string, 2> materials;  ///< names of the two materials
  double static_friction = 0.8;          ///< coefficient of friction at rest [-]
  double kinetic_friction = 0.8;  ///< coefficient of sliding friction [-], at most the static one
  double restitution = 0;         ///< normal speed of separation / normal speed of approach [-]
  double softness = 0;            ///< penetration depth / contact force [m/N]; 0: rigid
  std::string names;              ///< names of both materials as one text, as in the file

  /// Passes the fields of a <pair> to the visitor `f`.
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

/// Table of the material pairs of a scene. A link without a material uses the coefficient of
/// friction of its collision shapes instead.
struct Materials {
  std::string file;    ///< file with a table of pairs, which `pairs` includes; empty: none
  std::string ground;  ///< material of the ground; empty: none
  std::vector<MaterialPair> pairs;  ///< contact properties of all pairs

  /// Passes the fields of <navvy:materials> to the visitor `f`.
  void describe(Fields& f) {
    f("file", file,
      "Table of pairs: a file beside the scene or a shipped one (`materials.sdf`: steel, stone, "
      "rubber, earth).",
      kShown);
    f("ground", ground, "Material of the ground.");
    f("pair", pairs, limits::kMaterialPairs, "Contact properties of two materials.");
  }
  /// Returns the entry for the materials named `a` and `b`; null if the table has none.
  const MaterialPair* pair(const std::string& a, const std::string& b) const {
    for (const MaterialPair& each : pairs)
      if ((each.materials[0] == a && each.materials[1] == b) ||
          (each.materials[0] == b && each.materials[1] == a))
        return &each;
    return nullptr;
  }
};

/// Material of a link.
struct LinkMaterial {
  std::string name;  ///< name of the material; empty: none
  int line = 0;      ///< line in the machine's file, for messages
};

}  // namespace navvy::scene
