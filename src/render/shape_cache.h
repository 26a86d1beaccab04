// SPDX-License-Identifier: Apache-2.0
// Drawable bodies of visuals, made once each.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "render/shading.h"
#include "scene/frame.h"

class SoNode;

namespace navvy::render {

/// A body in its visual's frame: Coin nodes to draw and triangles (three points each) that throw
/// shadows; those of solid parts throw it only where they face the sun. The node is held by a
/// reference of Coin's, which the cache gives back at its end.
struct Shape {
  // One node for all visuals that look alike; each gets its pose from a parent of its own.
  SoNode* node = nullptr;
  std::vector<Vec3f> solid_triangles, open_triangles;
  // Box of all points, in the visual's frame.
  Vec3f low = Vec3f::Zero(), high = Vec3f::Zero();
};

/// Bodies by what they look like (geometry, file, scale, colour), so that equal wheels share one.
/// Nothing is ever dropped: a scene has some tens of looks. References stay good while the cache
/// lives, as a map does not move what it holds.
class ShapeCache {
 public:
  ShapeCache() = default;
  ~ShapeCache();
  ShapeCache(const ShapeCache&) = delete;
  ShapeCache& operator=(const ShapeCache&) = delete;

  /// @throws FileError for a mesh file that cannot be read, InputError for one that holds no mesh.
  const Shape& get(const scene::Visual& visual);
  /// Barrel (radius 1) or rod along +x from 0 to 1. Of unit radius and length, to be stretched
  /// between two pins; both are made at their first use.
  const Shape& cylinder_along_x(bool rod);
  /// Number of bodies that were made.
  std::size_t size() const { return shapes_.size(); }

 private:
  std::map<std::string, Shape> shapes_;
};

}  // namespace navvy::render
