// SPDX-License-Identifier: Apache-2.0
// The ground's heights with a lit colour per column, updated by rectangles.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "render/shading.h"
#include "scene/frame.h"

namespace navvy::render {

/// Half-open rectangle of columns.
struct ColumnRect {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  /// Returns true when it holds no column.
  bool empty() const { return x0 >= x1 || y0 >= y1; }
  /// Number of columns in it.
  std::int64_t area() const { return empty() ? 0 : static_cast<std::int64_t>(x1 - x0) * (y1 - y0); }
  /// Returns the smallest rectangle that holds both.
  ColumnRect with(const ColumnRect& other) const {
    return {std::min(x0, other.x0), std::min(y0, other.y0), std::max(x1, other.x1),
            std::max(y1, other.y1)};
  }
  /// Returns it enlarged by `cells` on every side, clamped to a ground of nx x ny columns.
  ColumnRect grown(int cells, int nx, int ny) const {
    return {std::max(0, x0 - cells), std::max(0, y0 - cells), std::min(nx, x1 + cells),
            std::min(ny, y1 + cells)};
  }
};

/// A copy of the ground's heights with, per column, albedo, visible shares of sun and sky, and the
/// lit colour.
///
/// Soil gives the base colour; the original surface is weathered, dug ground darker and moist,
/// dumped ground lighter and uneven; a faint tint follows height. The sun is traced over the
/// heights up to kShadowReach columns away.
class GroundSurface {
 public:
  /// Length of the ground's own shadows [columns].
  static constexpr int kShadowReach = 28;
  /// Radius of the neighbourhood that hides the sky [columns].
  static constexpr int kOpenReach = 5;

  /// Copies what changed in `ground`. Returns rectangles of the columns whose vertices or colours
  /// are new; none when nothing changed.
  std::vector<ColumnRect> update(const scene::FrameGround& ground, const Lighting& lighting);

  // The copied ground; columns and origin as in scene::FrameGround.
  int nx() const { return nx_; }
  int ny() const { return ny_; }
  float cell() const { return cell_; }
  float height(int ix, int iy) const { return height_[index(ix, iy)]; }
  /// Returns a column's centre in W [m].
  Vec3f point(int ix, int iy) const {
    return {x0_ + (static_cast<float>(ix) + 0.5f) * cell_,
            y0_ + (static_cast<float>(iy) + 0.5f) * cell_, height_[index(ix, iy)]};
  }
  /// Returns a column's lit colour, RGBA.
  const std::array<std::uint8_t, 4>& lit(int ix, int iy) const { return lit_[index(ix, iy)]; }
  /// Returns the lit colour of a wall at this column: freshly cut soil facing `normal`.
  Vec3f wall_color(int ix, int iy, const Vec3f& normal) const;
  /// Interpolates height [m] and share of the sun at a point of W. Returns false outside the
  /// ground.
  bool sample(float x, float y, float& height, float& sun) const;

 private:
  std::size_t index(int ix, int iy) const {
    return static_cast<std::size_t>(iy) * static_cast<std::size_t>(nx_) +
           static_cast<std::size_t>(ix);
  }
  /// Returns the frame's changed rectangles, or compares heights where a frame was missed.
  std::vector<ColumnRect> changed_cells(const scene::FrameGround& ground) const;
  /// Returns the bounding rectangle of all columns that differ from the frame's.
  ColumnRect compared(const scene::FrameGround& ground) const;
  /// Starts with a ground of another size, position, light or set of soils.
  void start(const scene::FrameGround& ground, const Lighting& lighting, std::size_t columns);
  /// Computes mean height and range, which the tint of the original surface follows.
  void measure_relief();
  void copy(const scene::FrameGround& ground, const ColumnRect& rect);
  // Each of these updates one field of the columns in `rect` from the heights around them.
  void find_openness(const ColumnRect& rect);
  void find_sun(const ColumnRect& rect);
  void paint(const ColumnRect& rect);
  /// Returns the colour of the soil before light: weathered, dug or dumped.
  Vec3f albedo(int ix, int iy) const;
  Vec3f normal(int ix, int iy) const;

  int nx_ = 0, ny_ = 0;
  float cell_ = 0.1f, x0_ = 0, y0_ = 0;
  // Revision of the frame copied last.
  std::uint64_t revision_ = 0;
  Lighting lighting_;
  float mean_height_ = 0, relief_ = 1;
  std::vector<scene::Color> soil_color_;
  // Per column, x fastest: height [m], change [m], scratch memory for sums.
  std::vector<float> height_, change_, scratch_;
  // Index of the soil; visible share of sky and sun, 255 = all.
  std::vector<std::uint8_t> soil_, open_, sun_;
  std::vector<std::array<std::uint8_t, 4>> lit_;
};

}  // namespace navvy::render
