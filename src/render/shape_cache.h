// SPDX-License-Identifier: Apache-2.0
// Bodies for the visuals of links, ready to draw. Each body is built only once.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "render/shading.h"
#include "scene/frame.h"

class SoNode;

namespace navvy::render {

/// A body that can be drawn, in the frame of its visual: a Coin node for drawing, and triangles
/// that cast shadows. The cache holds a Coin reference to the node for its whole lifetime.
struct Shape {
  /// Node with the geometry and colour, shared by all visuals of the same appearance. A parent node
  /// in the scene graph sets the pose of each visual.
  SoNode* node = nullptr;
  /// Corners of the triangles that cast shadows [m], three per triangle. `solid_triangles` belong
  /// to solid parts and cast a shadow only if they face the sun; `open_triangles` belong to all
  /// other parts.
  std::vector<Vec3f> solid_triangles, open_triangles;
  /// Corners of the bounding box in the frame of the visual [m].
  Vec3f low = Vec3f::Zero(), high = Vec3f::Zero();
};

/// A body at a pose that may stretch it. Two equal ones cast the same shadow.
struct PlacedShape {
  const Shape* shape;    ///< the body
  Eigen::Matrix4f X_WS;  ///< affine map from the body's frame to W

  bool operator==(const PlacedShape& o) const { return shape == o.shape && X_WS == o.X_WS; }
  /// Extends the box from `low` to `high` in W [m] by the corners of the body's own box: it becomes
  /// larger than needed if the body is turned, never smaller.
  void extend(Vec3f& low, Vec3f& high) const;
};

/// Caches bodies, keyed by appearance (geometry, mesh file, scale and colour), so that for example
/// equal wheels share one body. Bodies are never removed, because a scene has only some tens of
/// them. References stay valid for the lifetime of the cache.
class ShapeCache {
 public:
  ShapeCache() = default;
  ~ShapeCache();
  ShapeCache(const ShapeCache&) = delete;
  ShapeCache& operator=(const ShapeCache&) = delete;

  /// Returns the body of a visual, and builds it at the first request. @throws FileError if a mesh
  /// file cannot be read, InputError if it contains no mesh.
  const Shape& get(const scene::Visual& visual);
  /// Returns a cylinder of radius 1 m along the x axis from 0 to 1 m, to be scaled to the distance
  /// between two pins of a hydraulic cylinder: the rod if `rod` is true, else the barrel. Both
  /// differ in colour.
  const Shape& cylinder_along_x(bool rod);
  /// Returns the number of bodies built so far.
  std::size_t size() const { return shapes_.size(); }

 private:
  // Bodies, keyed by a text that describes the appearance.
  std::map<std::string, Shape> shapes_;
};

}  // namespace navvy::render
