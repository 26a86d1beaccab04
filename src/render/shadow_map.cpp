// SPDX-License-Identifier: Apache-2.0
#include "render/shadow_map.h"

#include <array>

namespace navvy::render {
namespace {
// Below every height: marks a texel without a caster.
constexpr float kNothing = -1e30f;
// Texels kept lit along the border.
constexpr int kMargin = 4;
}  // namespace

void ShadowMap::begin(const Lighting& lighting, const Vec3f& low, const Vec3f& high) {
  used_ = false;
  ++version_;
  to_sun_ = lighting.to_sun;
  nearest_.assign(kSize * kSize, kNothing);
  // Any two axes across the rays suffice, unless one is nearly parallel to them.
  const Vec3f side = std::abs(to_sun_.z()) > 0.95f ? Vec3f::UnitX() : Vec3f::UnitZ();
  const Vec3f u = side.cross(to_sun_).normalized(), v = to_sun_.cross(u);
  Eigen::Vector2f least(1e30f, 1e30f), most(-1e30f, -1e30f);
  for (int k = 0; k < 8; ++k) {
    const Vec3f p((k & 1) ? high.x() : low.x(), (k & 2) ? high.y() : low.y(),
                  (k & 4) ? high.z() : low.z());
    const Eigen::Vector2f q(u.dot(p), v.dot(p));
    least = least.cwiseMin(q);
    most = most.cwiseMax(q);
  }
  // The longer side sets the scale, so texels are square; a minimum of half a metre keeps the scale
  // finite.
  const float extent = std::max({most.x() - least.x(), most.y() - least.y(), 0.5f});
  // Leaves the margin and two texels for the blur.
  const float scale = (1.0f - 2.0f * (kMargin + 2) / kSize) / extent;
  const Eigen::Vector2f middle = 0.5f * (least + most);
  plane_s_ = {scale * u.x(), scale * u.y(), scale * u.z(), 0.5f - scale * middle.x()};
  plane_t_ = {scale * v.x(), scale * v.y(), scale * v.z(), 0.5f - scale * middle.y()};
}

Vec3f ShadowMap::project(const Vec3f& p) const {
  return {(plane_s_.head<3>().dot(p) + plane_s_.w()) * kSize,
          (plane_t_.head<3>().dot(p) + plane_t_.w()) * kSize, to_sun_.dot(p)};
}

// Rasterises row by row: the three edges bound the texels of a row, so that the inner loop only
// compares depths.
void ShadowMap::add_triangle(const Vec3f& wa, const Vec3f& wb, const Vec3f& wc, bool solid) {
  const Vec3f a = project(wa), b = project(wb), c = project(wc);
  // Twice the area in texels. Seen from the sun a front face is counter-clockwise; back faces of a
  // solid body are in the shadow of its front faces.
  const float area = (b.x() - a.x()) * (c.y() - a.y()) - (c.x() - a.x()) * (b.y() - a.y());
  if (solid ? area < 1e-6f : std::abs(area) < 1e-6f) return;
  used_ = true;
  const auto floor_of = [](float v) { return static_cast<int>(std::floor(v)); };
  const int low_x = std::max(kMargin, floor_of(std::min({a.x(), b.x(), c.x()})));
  const int high_x = std::min(kSize - 1 - kMargin, floor_of(std::max({a.x(), b.x(), c.x()})) + 1);
  const int low_y = std::max(kMargin, floor_of(std::min({a.y(), b.y(), c.y()})));
  const int high_y = std::min(kSize - 1 - kMargin, floor_of(std::max({a.y(), b.y(), c.y()})) + 1);
  // The weights of b and c (and of a, the rest) at a texel's centre are linear in x and y.
  const float inverse = 1.0f / area;
  const std::array<float, 3> per_x = {(c.y() - a.y()) * inverse, (a.y() - b.y()) * inverse,
                                      (b.y() - c.y()) * inverse};
  const std::array<float, 3> per_y = {(a.x() - c.x()) * inverse, (b.x() - a.x()) * inverse,
                                      (c.x() - b.x()) * inverse};
  const float highest = std::max({a.z(), b.z(), c.z()});
  const float slope = per_x[0] * (b.z() - a.z()) + per_x[1] * (c.z() - a.z());
  // Half a texel beyond each edge closes gaps between neighbours. More would be a rim that throws
  // its shadow on the faces around the edge.
  std::array<float, 3> slack;
  for (std::size_t k = 0; k < 3; ++k) slack[k] = -0.5f * std::hypot(per_x[k], per_y[k]);
  for (int y = low_y; y <= high_y; ++y) {
    const float px = static_cast<float>(low_x) + 0.5f - a.x(),
                py = static_cast<float>(y) + 0.5f - a.y();
    std::array<float, 3> share = {per_x[0] * px + per_y[0] * py, per_x[1] * px + per_y[1] * py, 0};
    share[2] = 1 - share[0] - share[1];
    // Each edge bounds the row from one side. An edge parallel to the row includes or excludes all
    // of it.
    float first = 0, last = static_cast<float>(high_x - low_x);
    for (std::size_t k = 0; k < 3; ++k) {
      const float missing = slack[k] - share[k];
      if (per_x[k] > 0)
        first = std::max(first, missing / per_x[k]);
      else if (per_x[k] < 0)
        last = std::min(last, missing / per_x[k]);
      else if (missing > 0)
        last = -1;
    }
    if (!(first <= last)) continue;
    // The height along the sun's direction is linear over a triangle. Beyond its edges it may not
    // rise above the highest corner: a triangle seen edge-on is steep.
    float* row = &nearest_[static_cast<std::size_t>(y * kSize + low_x)];
    const float start = a.z() + share[0] * (b.z() - a.z()) + share[1] * (c.z() - a.z());
    const int end = static_cast<int>(last);
    for (int x = static_cast<int>(std::ceil(first)); x <= end; ++x)
      row[x] = std::max(row[x], std::min(start + slope * static_cast<float>(x), highest));
  }
}

void ShadowMap::add_point(const Vec3f& p, float radius) {
  const Vec3f q = project(p);
  // A particle counts as a square of its diameter, since the map is blurred anyway.
  const float r = radius * plane_s_.head<3>().norm() * kSize;
  used_ = true;
  for (int y = std::max(kMargin, static_cast<int>(q.y() - r));
       y <= std::min(kSize - 1 - kMargin, static_cast<int>(q.y() + r)); ++y)
    for (int x = std::max(kMargin, static_cast<int>(q.x() - r));
         x <= std::min(kSize - 1 - kMargin, static_cast<int>(q.x() + r)); ++x) {
      float& near = nearest_[static_cast<std::size_t>(y * kSize + x)];
      near = std::max(near, q.z());
    }
}

namespace {

/// Computes the weighted mean (1 2 2 2 1) / 8 of five values `stride` apart, along a run of texels.
void smooth(const std::uint8_t* __restrict in, std::uint8_t* __restrict out, int n, int stride) {
  for (int i = 0; i < n; ++i) {
    const int sum =
        in[i - 2 * stride] + 2 * (in[i - stride] + in[i] + in[i + stride]) + in[i + 2 * stride];
    out[i] = static_cast<std::uint8_t>(sum >> 3);
  }
}

}  // namespace

void ShadowMap::finish() {
  mask_.resize(nearest_.size());
  blur_.assign(nearest_.size(), 255);
  lowest_ = 1e30f;
  highest_ = -lowest_;
  for (std::size_t i = 0; i < nearest_.size(); ++i) {
    mask_[i] = nearest_[i] > kNothing ? 0 : 255;
    if (mask_[i] != 0) continue;
    lowest_ = std::min(lowest_, nearest_[i]);
    highest_ = std::max(highest_, nearest_[i]);
  }
  // A margin, so that depth 0 is below all casters; half a metre keeps the scale finite.
  lowest_ = used_ && lowest_ < highest_ ? lowest_ - 0.5f : 0;
  highest_ = std::max(highest_, lowest_ + 0.5f);
  // Rows run on into each other, because their ends are margin and lit.
  constexpr int kInner = (kSize - 4) * kSize - 4;
  smooth(&mask_[2 * kSize + 2], &blur_[2 * kSize + 2], kInner, 1);
  smooth(&blur_[2 * kSize + 2], &mask_[2 * kSize + 2], kInner, kSize);
  dark_.assign(kSquares * kSquares, 0);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x)
      if (mask_[static_cast<std::size_t>(y * kSize + x)] != 255)
        dark_[static_cast<std::size_t>(y / kSquare * kSquares + x / kSquare)] = 1;
}

bool ShadowMap::reaches(const Vec3f& low, const Vec3f& high) const {
  if (!used_ || !covers(low, high)) return false;
  // The squares that the box covers, with one beyond them, as textures are interpolated.
  std::array<int, 2> first, last;
  for (std::size_t k = 0; k < 2; ++k) {
    const Eigen::Vector4f& plane = k == 0 ? plane_s_ : plane_t_;
    const Vec3f middle = 0.5f * (low + high), half = 0.5f * (high - low);
    const float at = plane.head<3>().dot(middle) + plane.w(),
                reach = plane.head<3>().cwiseAbs().dot(half);
    const auto square = [](float s) {
      return static_cast<int>(std::floor(std::clamp(s, 0.0f, 1.0f) * kSquares));
    };
    first[k] = std::max(0, square(at - reach) - 1);
    last[k] = std::min(kSquares - 1, square(at + reach) + 1);
  }
  for (int y = first[1]; y <= last[1]; ++y)
    for (int x = first[0]; x <= last[0]; ++x)
      if (dark_[static_cast<std::size_t>(y * kSquares + x)] != 0) return true;
  return false;
}

Eigen::Vector4f ShadowMap::plane_r() const {
  const float scale = 1 / (highest_ - lowest_);
  return {scale * to_sun_.x(), scale * to_sun_.y(), scale * to_sun_.z(), -scale * lowest_};
}

std::vector<float> ShadowMap::depths() const {
  std::vector<float> out(nearest_.size());
  const float scale = 1 / (highest_ - lowest_);
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = std::clamp((nearest_[i] - lowest_) * scale, 0.0f, 1.0f);
  return out;
}

bool ShadowMap::covers(const Vec3f& low, const Vec3f& high) const {
  const Vec3f middle = 0.5f * (low + high), half = 0.5f * (high - low);
  for (const Eigen::Vector4f* plane : {&plane_s_, &plane_t_}) {
    // Extent of the box along a direction; the test may be true for a box near the map, but is
    // never false for one in it.
    const float at = plane->head<3>().dot(middle) + plane->w(),
                reach = plane->head<3>().cwiseAbs().dot(half);
    if (at + reach < 0 || at - reach > 1) return false;
  }
  return true;
}

float ShadowMap::sun_at(const Vec3f& p, float bias) const {
  if (!used_) return 1;
  // Beyond the map there are no casters. One texel of margin for the mean below.
  const Vec3f q = project(p);
  const int x = static_cast<int>(std::floor(q.x())), y = static_cast<int>(std::floor(q.y()));
  if (x < 1 || y < 1 || x >= kSize - 1 || y >= kSize - 1) return 1;
  // The mean of nine comparisons softens the shadow's edge on airborne soil.
  int lit = 0;
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx)
      lit += nearest_[static_cast<std::size_t>((y + dy) * kSize + x + dx)] <= q.z() + bias ? 1 : 0;
  return static_cast<float>(lit) / 9.0f;
}

}  // namespace navvy::render
