// SPDX-License-Identifier: Apache-2.0
// The ground's heights with a lit colour per column, brought up to date by rectangles.
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
  /// Holds no column.
  bool empty() const { return x0 >= x1 || y0 >= y1; }
  /// Columns in it.
  std::int64_t area() const { return empty() ? 0 : static_cast<std::int64_t>(x1 - x0) * (y1 - y0); }
  /// The smallest that holds both.
  ColumnRect with(const ColumnRect& other) const {
    return {std::min(x0, other.x0), std::min(y0, other.y0), std::max(x1, other.x1),
            std::max(y1, other.y1)};
  }
  /// With `cells` more on every side, as far as a ground of nx x ny columns reaches.
  ColumnRect grown(int cells, int nx, int ny) const {
    return {std::max(0, x0 - cells), std::max(0, y0 - cells), std::min(nx, x1 + cells),
            std::min(ny, y1 + cells)};
  }
};

/// Keeps a copy of the ground's heights and, per column, albedo, share of sun and sky, and the lit
/// colour.
///
/// Soil gives the base colour; the old surface is weathered, dug ground darker and moist, dumped
/// ground lighter and uneven; a faint tint follows height. The sun is traced over the heights up to
/// kShadowReach columns away.
class GroundSurface {
 public:
  static constexpr int kShadowReach = 28;  ///< columns a shadow of the ground may fall
  static constexpr int kOpenReach = 5;     ///< columns of the neighbourhood that hides the sky

  /// Takes over what changed in `ground`; returns rectangles of the columns whose vertices or
  /// colours are new (none: nothing is).
  std::vector<ColumnRect> update(const scene::FrameGround& ground, const Lighting& lighting);

  // The ground as last taken over; columns and origin as in scene::FrameGround.
  int nx() const { return nx_; }
  int ny() const { return ny_; }
  float cell() const { return cell_; }
  float height(int ix, int iy) const { return height_[index(ix, iy)]; }
  /// Column centre in W [m].
  Vec3f point(int ix, int iy) const {
    return {x0_ + (static_cast<float>(ix) + 0.5f) * cell_,
            y0_ + (static_cast<float>(iy) + 0.5f) * cell_, height_[index(ix, iy)]};
  }
  /// Colour in the light, RGBA.
  const std::array<std::uint8_t, 4>& lit(int ix, int iy) const { return lit_[index(ix, iy)]; }
  /// Colour of a wall at this column: freshly cut soil facing `normal`.
  Vec3f wall_color(int ix, int iy, const Vec3f& normal) const;
  /// Interpolated height and openness at a point of W; false outside.
  bool sample(float x, float y, float& height, float& sun) const;
  /// Of the ground at the start [m].
  float mean_height() const { return mean_height_; }

 private:
  std::size_t index(int ix, int iy) const {
    return static_cast<std::size_t>(iy) * static_cast<std::size_t>(nx_) +
           static_cast<std::size_t>(ix);
  }
  /// What the frame tells, or what a comparison finds where a frame was missed.
  std::vector<ColumnRect> changed_cells(const scene::FrameGround& ground) const;
  /// Bounding rectangle of all columns that differ from the frame's.
  ColumnRect compared(const scene::FrameGround& ground) const;
  /// Begins a ground of another size, place, light or soils.
  void start(const scene::FrameGround& ground, const Lighting& lighting, std::size_t columns);
  /// Mean height and range, which the tint of the old surface follows.
  void measure_relief();
  void copy(const scene::FrameGround& ground, const ColumnRect& rect);
  // Each renews one field of the columns in `rect` from the heights around them.
  void find_openness(const ColumnRect& rect);
  void find_sun(const ColumnRect& rect);
  void paint(const ColumnRect& rect);
  /// Colour of the soil before light: weathered, dug or dumped.
  Vec3f albedo(int ix, int iy) const;
  Vec3f normal(int ix, int iy) const;

  int nx_ = 0, ny_ = 0;
  float cell_ = 0.1f, x0_ = 0, y0_ = 0;
  // Of the frame taken over last.
  std::uint64_t revision_ = 0;
  Lighting lighting_;
  float mean_height_ = 0, relief_ = 1;
  std::vector<scene::Color> soil_color_;
  // By column, x fastest: [m], [m], room for sums.
  std::vector<float> height_, change_, scratch_;
  // Index of the soil; share of the sky and of the sun, 255 = all.
  std::vector<std::uint8_t> soil_, open_, sun_;
  std::vector<std::array<std::uint8_t, 4>> lit_;
};

}  // namespace navvy::render
