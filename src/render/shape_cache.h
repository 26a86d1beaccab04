// SPDX-License-Identifier: Apache-2.0
// Drawable bodies of visuals, each built once.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "render/shading.h"
#include "scene/frame.h"

class SoNode;

namespace navvy::render {

/// A body in its visual's frame: Coin nodes to draw, and triangles (three points each) that cast
/// shadows; triangles of solid parts cast them only where they face the sun. The cache holds a Coin
/// reference to the node until it is destroyed.
struct Shape {
  // One node for all visuals that look alike; a parent of each visual sets its pose.
  SoNode* node = nullptr;
  std::vector<Vec3f> solid_triangles, open_triangles;
  // Bounding box in the visual's frame [m].
  Vec3f low = Vec3f::Zero(), high = Vec3f::Zero();
};

/// Bodies by appearance (geometry, file, scale, colour), so that equal wheels share one. Nothing is
/// ever dropped, as a scene has some tens of shapes. References stay valid while the cache lives.
class ShapeCache {
 public:
  ShapeCache() = default;
  ~ShapeCache();
  ShapeCache(const ShapeCache&) = delete;
  ShapeCache& operator=(const ShapeCache&) = delete;

  /// Returns the body of a visual, built at its first use. @throws FileError for a mesh file that
  /// cannot be read, InputError for one that holds no mesh.
  const Shape& get(const scene::Visual& visual);
  /// Returns a barrel (radius 1) or rod along +x from 0 to 1, to be scaled between two pins; both
  /// are built at their first use.
  const Shape& cylinder_along_x(bool rod);
  /// Number of bodies built so far.
  std::size_t size() const { return shapes_.size(); }

 private:
  std::map<std::string, Shape> shapes_;
};

}  // namespace navvy::render
