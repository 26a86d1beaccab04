// SPDX-License-Identifier: Apache-2.0
// Shadows of machines and falling soil: one map for the ground, and a finer one for each group of
// bodies that stand together, for the shadows that they cast on themselves and on each other.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "render/shadow_map.h"
#include "render/shape_cache.h"

namespace navvy::render {

/// Keeps the shadow maps of a picture. They are made again only when a caster or the light changes,
/// so another camera at the same time uses them, too.
class BodyShadows {
 public:
  /// Bodies that are less than kApart from each other, such as those of one machine.
  struct Group {
    std::vector<std::size_t> bodies;     ///< indices of the bodies
    const ShadowMap* shadows = nullptr;  ///< shadows on these bodies; owned by BodyShadows
  };
  /// Distance between two groups of bodies [m].
  static constexpr float kApart = 1;

  /// Makes the maps for `bodies`, and for particles of `radius` [m] that fall at points in W [m].
  void update(const std::vector<PlacedShape>& bodies, const std::vector<Vec3f>& falling,
              float radius, const Lighting& lighting);
  /// Makes maps without shadows for `bodies`.
  void clear(const std::vector<PlacedShape>& bodies, const Lighting& lighting);

  /// Returns the map of all casters, for the ground and the soil.
  const ShadowMap& ground() const { return ground_; }
  /// Returns the groups; each body belongs to one.
  const std::vector<Group>& groups() const { return groups_; }

 private:
  // Divides the bodies into groups.
  void find_groups();
  // Adds the bodies and the falling particles that can throw a shadow within a map.
  void cast(ShadowMap& map) const;

  ShadowMap ground_;
  std::vector<Group> groups_;
  // One map per group if there are several; reused in order to reuse their memory.
  std::vector<std::unique_ptr<ShadowMap>> maps_;
  // Content of the maps.
  std::vector<PlacedShape> bodies_;
  std::vector<Vec3f> falling_;
  float radius_ = 0;
  Lighting lighting_;
  // Boxes of the bodies in W [m].
  std::vector<Vec3f> low_, high_;
};

}  // namespace navvy::render
