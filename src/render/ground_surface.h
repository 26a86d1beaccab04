// SPDX-License-Identifier: Apache-2.0
// A copy of the ground's heights with one lit colour per column. Only changed rectangles are
// updated.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "render/shading.h"
#include "scene/frame.h"

namespace navvy::render {

/// A rectangle of columns, x0 <= ix < x1 and y0 <= iy < y1.
struct ColumnRect {
  /// The rectangle begins with column x0 and ends before column x1; the same holds for y0 and y1.
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  /// Returns true if the rectangle contains no column.
  bool empty() const { return x0 >= x1 || y0 >= y1; }
  /// Returns the number of columns in the rectangle.
  std::int64_t area() const { return empty() ? 0 : static_cast<std::int64_t>(x1 - x0) * (y1 - y0); }
  /// Returns the smallest rectangle that contains this one and `other`.
  ColumnRect with(const ColumnRect& other) const {
    return {std::min(x0, other.x0), std::min(y0, other.y0), std::max(x1, other.x1),
            std::max(y1, other.y1)};
  }
  /// Returns this rectangle enlarged by `cells` columns on every side and clamped to a ground of nx
  /// x ny columns.
  ColumnRect grown(int cells, int nx, int ny) const {
    return {std::max(0, x0 - cells), std::max(0, y0 - cells), std::min(nx, x1 + cells),
            std::min(ny, y1 + cells)};
  }
};

/// The four columns around a point, with their shares of it as in bilinear interpolation.
struct ColumnShares {
  std::array<float, 4> height = {};  ///< heights of the columns in W [m]
  std::array<float, 4> share = {};   ///< shares of the columns, which sum to 1
  /// Returns the share of space that the columns fill at the height `z` in W [m]: it falls from 1
  /// to 0 over `ramp` [m] below to `ramp` above each column's surface.
  float filled(float z, float ramp) const {
    float sum = 0;
    for (std::size_t c = 0; c < 4; ++c)
      sum += share[c] * std::clamp(0.5f - 0.5f * (z - height[c]) / ramp, 0.0f, 1.0f);
    return sum;
  }
};

/// The drawn ground at a point, interpolated between the four columns around it.
struct GroundLook {
  Vec3f color = Vec3f::Zero();  ///< lit colour
  float height = 0;             ///< height in W with the loose soil on it [m]
  float range = 0;              ///< range of the heights of the four columns [m]
};

/// A copy of the ground's heights. For each column it also stores the visible fractions of sun and
/// sky, and the lit colour.
///
/// The type of soil gives the base colour. The original surface looks weathered, dug ground is
/// darker and moist where the soil holds water, and dumped ground is lighter and uneven; a faint
/// tint depends on the height. Rays to the sun are traced over the heights for up to kShadowReach
/// columns. Light and colour are those of the surface with the loose soil on it
/// (scene::FrameGround::top).
///
/// Dumped soil lies in columns of unlike heights, a lattice that nobody sees in the field: such
/// columns are drawn at heights smoothed with those of their neighbours, unless `smooth` is false.
class GroundSurface {
 public:
  /// Maximum length of the shadows that the ground casts on itself [columns].
  static constexpr int kShadowReach = 28;
  /// Distance up to which surrounding ground hides the sky [columns].
  static constexpr int kOpenReach = 5;
  /// Depth below the surface of loose soil at which the columns under it are drawn [columns].
  static constexpr float kBuried = 0.8f;

  /// Creates an empty copy. `smooth`: see above; false for pictures that are measured.
  explicit GroundSurface(bool smooth = true) : smooth_(smooth) {}

  /// Copies the changed columns of `ground` and lights them and their surroundings. Returns
  /// rectangles that contain all columns with a new height or colour; empty if nothing has changed.
  /// @throws Error if the sizes of the frame's arrays do not match.
  std::vector<ColumnRect> update(const scene::FrameGround& ground, const Lighting& lighting);

  /// Returns the number of columns in x direction.
  int nx() const { return nx_; }
  /// Returns the number of columns in y direction.
  int ny() const { return ny_; }
  /// Returns the edge length of a column [m].
  float cell() const { return cell_; }
  /// Returns the height at which a column is drawn in W [m]. Columns below loose soil are drawn
  /// close to its surface, so that no wall between them and their neighbours shows through it.
  float height(int ix, int iy) const { return drawn_[index(ix, iy)]; }
  /// Returns true if loose soil lies on a column.
  bool loose(int ix, int iy) const { return raw_top_[index(ix, iy)] != raw_[index(ix, iy)]; }
  /// Returns the centre of a column's surface in W [m].
  Vec3f point(int ix, int iy) const {
    return {x0_ + (static_cast<float>(ix) + 0.5f) * cell_,
            y0_ + (static_cast<float>(iy) + 0.5f) * cell_, height(ix, iy)};
  }
  /// Returns the lit colour of a column as four bytes, RGBA.
  const std::array<std::uint8_t, 4>& lit(int ix, int iy) const { return lit_[index(ix, iy)]; }
  /// Returns the lit colour (RGB, 0 to 1) of a wall at a column. A wall looks like freshly cut
  /// soil; `normal` is its unit normal in W.
  Vec3f wall_color(int ix, int iy, const Vec3f& normal) const;
  /// Finds the column at the point (x, y) in W [m], and returns in the last two parameters the
  /// height in W [m] of its surface with the loose soil on it, and the visible fraction of the sun
  /// (0 to 1). Returns false, without setting them, if the point is outside the ground.
  bool sample(float x, float y, float& height, float& sun) const;
  /// Returns the columns around the point (x, y) in W [m], without the loose soil on them. A point
  /// outside the ground has those at its edge. The ground must have two columns each way at least.
  ColumnShares columns_at(float x, float y) const;
  /// Returns the ground at the point (x, y) in W [m]; arguments as for `columns_at`.
  GroundLook look_at(float x, float y) const;
  /// Returns the unlit colour of loose soil of the kind `soil` at the point `p` in W [m].
  Vec3f loose_albedo(const Vec3f& p, std::uint8_t soil) const;

 private:
  /// The four columns around a point: index of each, and its share as in bilinear interpolation.
  struct Around {
    std::array<std::size_t, 4> index;
    std::array<float, 4> share;
  };
  /// Returns the columns around a point; arguments as for `columns_at`.
  Around around(float x, float y) const;
  /// Returns the index of a column in the arrays below; ix varies fastest.
  std::size_t index(int ix, int iy) const {
    return static_cast<std::size_t>(iy) * static_cast<std::size_t>(nx_) +
           static_cast<std::size_t>(ix);
  }
  /// Returns the changed rectangles that the frame reports. If an earlier frame was not copied,
  /// compares all columns instead.
  std::vector<ColumnRect> changed_cells(const scene::FrameGround& ground) const;
  /// Returns the bounding rectangle of all columns that differ from those of the frame.
  ColumnRect compared(const scene::FrameGround& ground) const;
  /// Resets the copy for a ground with another size, position, lighting or set of soils. `columns`
  /// is the number of columns.
  void start(const scene::FrameGround& ground, const Lighting& lighting, std::size_t columns);
  /// Computes mean height and height range of the original surface, which determine the tint.
  void measure_relief();
  /// Returns true if column `i` of the frame differs from the copy.
  bool differs(const scene::FrameGround& ground, std::size_t i) const;
  /// Copies the frame's data of the columns in `rect`, and smooths those in and around it.
  void copy(const scene::FrameGround& ground, const ColumnRect& rect);
  /// Computes the visible fraction of the sky for the columns in `rect`.
  void find_openness(const ColumnRect& rect);
  /// Computes the visible fraction of the sun for the columns in `rect`.
  void find_sun(const ColumnRect& rect);
  /// Computes the lit colours of the columns in `rect`.
  void paint(const ColumnRect& rect);
  /// Sets the heights of a column that has been copied, from those of its neighbours.
  void smooth(int ix, int iy);
  /// Sets the height at which a column is drawn; its neighbours have been smoothed.
  void bury(int ix, int iy);
  /// Returns the base colour of a soil; brown without soils.
  Vec3f base_color(std::uint8_t soil) const;
  /// Returns the unlit colour of a column: weathered, dug or dumped soil.
  Vec3f albedo(int ix, int iy) const;
  /// Returns the unlit colour of soil of the kind `soil` at a height in W [m].
  /// `change` is the height above that at the start of the run [m]; `broad` is the noise of
  /// patches, `fine` noise of -1 to 1.
  Vec3f weathered(std::uint8_t soil, float height, float change, float broad, float fine) const;
  /// Returns the unit normal of the surface at a column in W.
  Vec3f normal(int ix, int iy) const;

  // Number of columns in x and y direction.
  int nx_ = 0, ny_ = 0;
  // Edge length of a column, and position of the ground's lower left corner in W [m].
  float cell_ = 0.1f, x0_ = 0, y0_ = 0;
  // Revision of the frame that was copied last.
  std::uint64_t revision_ = 0;
  // Lighting for which the colours were computed.
  Lighting lighting_;
  // Mean height in W and height range of the original surface [m].
  float mean_height_ = 0, relief_ = 1;
  // True if dumped soil is drawn at smoothed heights.
  bool smooth_;
  // Base colours, and whether freshly dug soil is moist, by the index of the soil.
  std::vector<scene::Color> soil_color_;
  std::vector<std::uint8_t> soil_moist_;
  // Scale of the colour by cut and fill [m]; 0: none.
  float cut_fill_ = 0;
  // Arrays with one entry per column: smoothed heights in W without and with loose soil [m], height
  // at which the column is drawn [m], the frame's heights without and with loose soil [m], and
  // change of height since the start [m]. `scratch_` is temporary memory for sums.
  std::vector<float> height_, top_, drawn_, raw_, raw_top_, change_, scratch_;
  // Arrays with one entry per column: index of the soil, and visible fractions of sky and sun (0 to
  // 255).
  std::vector<std::uint8_t> soil_, open_, sun_;
  // Noise of broad patches of each column (-1.5 to 1.5), the same for every frame.
  std::vector<float> broad_;
  // Lit colour of each column, RGBA.
  std::vector<std::array<std::uint8_t, 4>> lit_;
};

}  // namespace navvy::render
