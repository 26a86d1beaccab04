// SPDX-License-Identifier: Apache-2.0
// The view of the sun: which light rays machines and falling soil intercept, and at what depth.
#pragma once

#include <vector>

#include "render/shading.h"

namespace navvy::render {

/// A square of texels across the sun's rays. `mask` (255 = lit) is projected on the ground as a
/// texture; points in the air ask `sun_at`, which compares depths. One map per picture: casters
/// share its texels, so a machine far from the others makes them coarse.
class ShadowMap {
 public:
  /// Texels along an edge.
  static constexpr int kSize = 512;

  /// Starts a new map for casters inside the box `low`..`high` of W. Shadows of casters outside it
  /// are cut off.
  void begin(const Lighting& lighting, const Vec3f& low, const Vec3f& high);
  /// Adds a triangle. Of a solid body only triangles that face the sun count.
  void add_triangle(const Vec3f& a, const Vec3f& b, const Vec3f& c, bool solid);
  /// Adds a round particle as a square of its width.
  void add_point(const Vec3f& p, float radius);
  /// Computes the mask with a soft edge. Until then the mask is that of the previous map.
  void finish();

  /// Returns true when nothing was added since `begin`; everything is lit then.
  bool empty() const { return !used_; }
  /// Number that changes with every new mask.
  std::uint64_t version() const { return version_; }
  /// Returns false only when the shadow cannot fall on anything inside a box.
  bool reaches(const Vec3f& low, const Vec3f& high) const;
  const std::vector<std::uint8_t>& mask() const { return mask_; }
  /// Texture coordinates = dot(plane.head<3>(), p) + plane.w, 0 to 1 over the map.
  const Eigen::Vector4f& plane_s() const { return plane_s_; }
  const Eigen::Vector4f& plane_t() const { return plane_t_; }
  /// Returns the share of the sun (0..1) at p, ignoring casters less than `bias` [m] nearer the
  /// sun. 1 beyond the map.
  float sun_at(const Vec3f& p, float bias) const;

 private:
  // Returns p's position on the map in texels, and its height along the sun's direction [m].
  Vec3f project(const Vec3f& p) const;

  bool used_ = false;
  std::uint64_t version_ = 0;
  Vec3f to_sun_ = Vec3f::UnitZ();
  Eigen::Vector4f plane_s_ = Eigen::Vector4f::Zero(), plane_t_ = Eigen::Vector4f::Zero();
  // Largest height along the sun's direction, per texel [m].
  std::vector<float> nearest_;
  std::vector<std::uint8_t> mask_, blur_;
};

}  // namespace navvy::render
