// SPDX-License-Identifier: Apache-2.0
#include "render/shadow_map.h"

namespace navvy::render {
namespace {
constexpr float kNothing = -1e30f;
constexpr int kMargin = 4;  // texels kept lit along the border
}  // namespace

void ShadowMap::begin(const Lighting& lighting, const Vec3f& low, const Vec3f& high) {
  used_ = false;
  to_sun_ = lighting.to_sun;
  nearest_.assign(kSize * kSize, kNothing);
  const Vec3f side = std::abs(to_sun_.z()) > 0.95f ? Vec3f::UnitX() : Vec3f::UnitZ();
  const Vec3f u = side.cross(to_sun_).normalized(), v = to_sun_.cross(u);
  Eigen::Vector2f least(1e30f, 1e30f), most(-1e30f, -1e30f);
  for (int k = 0; k < 8; ++k) {
    const Vec3f p((k & 1) ? high.x() : low.x(), (k & 2) ? high.y() : low.y(), (k & 4) ? high.z() : low.z());
    const Eigen::Vector2f q(u.dot(p), v.dot(p));
    least = least.cwiseMin(q);
    most = most.cwiseMax(q);
  }
  const float extent = std::max({most.x() - least.x(), most.y() - least.y(), 0.5f});
  const float scale = (1.0f - 2.0f * (kMargin + 2) / kSize) / extent;
  const Eigen::Vector2f middle = 0.5f * (least + most);
  plane_s_ << scale * u, 0.5f - scale * middle.x();
  plane_t_ << scale * v, 0.5f - scale * middle.y();
}

Vec3f ShadowMap::project(const Vec3f& p) const {
  return {(plane_s_.head<3>().dot(p) + plane_s_.w()) * kSize, (plane_t_.head<3>().dot(p) + plane_t_.w()) * kSize,
          to_sun_.dot(p)};
}

void ShadowMap::add_triangle(const Vec3f& wa, const Vec3f& wb, const Vec3f& wc) {
  const Vec3f a = project(wa), b = project(wb), c = project(wc);
  const int x0 = std::max(kMargin, static_cast<int>(std::floor(std::min({a.x(), b.x(), c.x()}))));
  const int x1 = std::min(kSize - 1 - kMargin, static_cast<int>(std::ceil(std::max({a.x(), b.x(), c.x()}))));
  const int y0 = std::max(kMargin, static_cast<int>(std::floor(std::min({a.y(), b.y(), c.y()}))));
  const int y1 = std::min(kSize - 1 - kMargin, static_cast<int>(std::ceil(std::max({a.y(), b.y(), c.y()}))));
  const float area = (b.x() - a.x()) * (c.y() - a.y()) - (c.x() - a.x()) * (b.y() - a.y());
  if (std::abs(area) < 1e-6f) return;
  used_ = true;
  const float inverse = 1.0f / area;
  constexpr float kSlack = -0.02f;  // no gaps between neighbours
  for (int y = y0; y <= y1; ++y)
    for (int x = x0; x <= x1; ++x) {
      const float px = static_cast<float>(x) + 0.5f, py = static_cast<float>(y) + 0.5f;
      const float wb2 = ((px - a.x()) * (c.y() - a.y()) - (c.x() - a.x()) * (py - a.y())) * inverse;
      const float wc2 = ((b.x() - a.x()) * (py - a.y()) - (px - a.x()) * (b.y() - a.y())) * inverse;
      if (wb2 < kSlack || wc2 < kSlack || wb2 + wc2 > 1 - kSlack) continue;
      float& near = nearest_[static_cast<std::size_t>(y * kSize + x)];
      near = std::max(near, a.z() + wb2 * (b.z() - a.z()) + wc2 * (c.z() - a.z()));
    }
}

void ShadowMap::add_point(const Vec3f& p, float radius) {
  const Vec3f q = project(p);
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

void ShadowMap::finish() {
  mask_.resize(nearest_.size());
  blur_.resize(nearest_.size());
  for (std::size_t i = 0; i < nearest_.size(); ++i) mask_[i] = nearest_[i] > kNothing ? 0 : 255;
  const auto at = [](int x, int y) { return static_cast<std::size_t>(y * kSize + x); };
  const auto smooth = [&](const std::vector<std::uint8_t>& in, std::vector<std::uint8_t>& out, int dx, int dy) {
    out.assign(in.size(), 255);
    for (int y = 2; y < kSize - 2; ++y)
      for (int x = 2; x < kSize - 2; ++x)
        out[at(x, y)] =
            static_cast<std::uint8_t>((in[at(x - 2 * dx, y - 2 * dy)] + 2 * in[at(x - dx, y - dy)] + 2 * in[at(x, y)] +
                                       2 * in[at(x + dx, y + dy)] + in[at(x + 2 * dx, y + 2 * dy)]) /
                                      8);
  };
  smooth(mask_, blur_, 1, 0);
  smooth(blur_, mask_, 0, 1);
}

float ShadowMap::sun_at(const Vec3f& p, float bias) const {
  if (!used_) return 1;
  const Vec3f q = project(p);
  const int x = static_cast<int>(std::floor(q.x())), y = static_cast<int>(std::floor(q.y()));
  if (x < 1 || y < 1 || x >= kSize - 1 || y >= kSize - 1) return 1;
  int lit = 0;
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx)
      lit += nearest_[static_cast<std::size_t>((y + dy) * kSize + x + dx)] <= q.z() + bias ? 1 : 0;
  return static_cast<float>(lit) / 9.0f;
}

}  // namespace navvy::render
