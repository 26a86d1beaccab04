// SPDX-License-Identifier: Apache-2.0
// Shadow map: a depth picture as seen from the sun, which shows where machines and falling soil
// block the light.
#pragma once

#include <vector>

#include "render/shading.h"

namespace navvy::render {

/// A square grid of texels in a plane perpendicular to the sun's rays. Objects that cast shadows
/// are added to it (casters).
///
/// The mask is projected on the ground as a texture. For points in the air, `sun_at` compares
/// depths. One map covers all casters of a picture, so distant casters make its texels coarse.
class ShadowMap {
 public:
  /// Number of texels along an edge of the map.
  static constexpr int kSize = 512;

  /// Starts a new map. It covers the box from `low` to `high` in W [m], which should contain all
  /// casters: parts outside the box cast no shadow.
  void begin(const Lighting& lighting, const Vec3f& low, const Vec3f& high);
  /// Adds a triangle with the corners a, b and c in W [m]. If it belongs to a solid body (`solid`),
  /// it is ignored unless it faces the sun.
  void add_triangle(const Vec3f& a, const Vec3f& b, const Vec3f& c, bool solid);
  /// Adds a particle at `p` in W [m] as a square as wide as the particle. `radius` is the
  /// particle's radius [m].
  void add_point(const Vec3f& p, float radius);
  /// Computes the mask, with soft edges. Before this call, `mask` still returns that of the
  /// previous map.
  void finish();

  /// Returns true if nothing has been added since `begin`, so that there are no shadows.
  bool empty() const { return !used_; }
  /// Returns a number that changes whenever a new map is started. It shows whether a copy of the
  /// mask is outdated.
  std::uint64_t version() const { return version_; }
  /// Returns false if no shadow can fall on anything inside the box from `low` to `high` in W [m].
  /// May return true without need.
  bool reaches(const Vec3f& low, const Vec3f& high) const;
  /// Returns false if no ray of the sun through the box from `low` to `high` in W [m] crosses the
  /// map. May return true without need.
  bool covers(const Vec3f& low, const Vec3f& high) const;
  /// Returns the mask, one byte per texel: 255 is fully lit, 0 in full shadow.
  const std::vector<std::uint8_t>& mask() const { return mask_; }
  /// Returns the plane for the texture coordinate s of a point p in W: s = dot(plane.head<3>(), p)
  /// + plane.w. The coordinate is 0 to 1 within the map.
  const Eigen::Vector4f& plane_s() const { return plane_s_; }
  /// Returns the plane for the texture coordinate t, defined as for `plane_s`.
  const Eigen::Vector4f& plane_t() const { return plane_t_; }
  /// Returns the plane for the depth r of a point p in W, defined as for `plane_s`: from 0 below
  /// all casters to 1 at the one nearest to the sun.
  Eigen::Vector4f plane_r() const;
  /// Returns for each texel the depth of the caster nearest to the sun; 0: none.
  std::vector<float> depths() const;
  /// Returns the edge of a texel [m].
  float texel() const { return 1 / (plane_s_.head<3>().norm() * kSize); }
  /// Returns the visible fraction of the sun (0 to 1) at the point `p` in W [m]; 1 outside the map.
  /// Casters that are less than `bias` [m] nearer to the sun than `p` are ignored, so that a body
  /// does not shadow itself.
  float sun_at(const Vec3f& p, float bias) const;

 private:
  // Number of texels along the edge of a square of the mask.
  static constexpr int kSquare = 16, kSquares = kSize / kSquare;
  // Returns the position of `p` on the map [texels] (x, y), and its height in the direction of the
  // sun [m] (z).
  Vec3f project(const Vec3f& p) const;

  // True if a caster has been added since `begin`.
  bool used_ = false;
  // Number that changes whenever a new map is started.
  std::uint64_t version_ = 0;
  // Unit vector towards the sun in W.
  Vec3f to_sun_ = Vec3f::UnitZ();
  // Heights of the lowest and the highest caster in the direction of the sun [m]; with `finish`.
  float lowest_ = 0, highest_ = 1;
  // Planes that convert a point in W to the texture coordinates s and t.
  Eigen::Vector4f plane_s_ = Eigen::Vector4f::Zero(), plane_t_ = Eigen::Vector4f::Zero();
  // For each texel, the height of the caster nearest to the sun, in the direction of the sun [m].
  std::vector<float> nearest_;
  // 1 for each square of kSquare x kSquare texels of the mask that holds a shadow.
  std::vector<std::uint8_t> dark_;
  // The mask (255 is fully lit), and temporary memory for its soft edges; one byte per texel.
  std::vector<std::uint8_t> mask_, blur_;
};

}  // namespace navvy::render
