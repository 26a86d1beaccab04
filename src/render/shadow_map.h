// SPDX-License-Identifier: Apache-2.0
// The sun's view of machines and falling soil: which light rays they hold up, and how near the sun.
#pragma once

#include <vector>

#include "render/shading.h"

namespace navvy::render {

/// A square of texels across the sun's rays. `mask` (255 = lit) is laid over the ground as a
/// texture along the rays; points in the air ask `sun_at`, which compares depths. One map for a
/// picture: casters inside a box share its texels, so a machine far from the others makes them
/// coarse.
class ShadowMap {
 public:
  /// Texels along an edge.
  static constexpr int kSize = 512;

  /// Starts anew for casters inside the box `low`..`high` of W. The box should hold all casters, or
  /// their shadows end at it.
  void begin(const Lighting& lighting, const Vec3f& low, const Vec3f& high);
  /// Of a solid body only the triangles that face the sun count.
  void add_triangle(const Vec3f& a, const Vec3f& b, const Vec3f& c, bool solid);
  /// A round particle, as a square of its width.
  void add_point(const Vec3f& p, float radius);
  /// Makes the mask, its edge softened. Without it the mask is that of the map before.
  void finish();

  /// True when nothing was added since `begin`; then everything is lit.
  bool empty() const { return !used_; }
  /// Changes with every new mask.
  std::uint64_t version() const { return version_; }
  /// Whether the shadow may fall on anything inside a box (never false where it does).
  bool reaches(const Vec3f& low, const Vec3f& high) const;
  const std::vector<std::uint8_t>& mask() const { return mask_; }
  /// Texture coordinate = dot(plane.head<3>(), p) + plane.w. The coordinate runs from 0 to 1 over
  /// the map.
  const Eigen::Vector4f& plane_s() const { return plane_s_; }
  const Eigen::Vector4f& plane_t() const { return plane_t_; }
  /// Share of the sun (0..1) at p, behind nothing nearer the sun than `bias` [m]. Beyond the map it
  /// is 1.
  float sun_at(const Vec3f& p, float bias) const;

 private:
  // Place of p on the map in texels, and its height along the sun's direction [m].
  Vec3f project(const Vec3f& p) const;

  bool used_ = false;
  std::uint64_t version_ = 0;
  Vec3f to_sun_ = Vec3f::UnitZ();
  Eigen::Vector4f plane_s_ = Eigen::Vector4f::Zero(), plane_t_ = Eigen::Vector4f::Zero();
  std::vector<float> nearest_;  ///< largest height along the sun's direction, per texel
  std::vector<std::uint8_t> mask_, blur_;
};

}  // namespace navvy::render
