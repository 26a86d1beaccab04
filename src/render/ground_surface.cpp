// SPDX-License-Identifier: Apache-2.0
// Light on the ground is computed per column when columns change. The sky and sun that a column
// sees depend on heights some columns around, so a changed rectangle is updated with its
// surroundings.
#include "render/ground_surface.h"

#include <cstring>

#include "core/error.h"

namespace navvy::render {
namespace {

/// Distance over which dumped soil is drawn smooth [columns].
constexpr int kSmoothReach = 2;

/// Returns the slope along one axis from its one-sided slopes: the mean where the ground is smooth,
/// the flatter one at an edge, so that a floor next to a wall stays lit as a floor.
float edge_slope(float a, float b) {
  // Difference of slopes that makes an edge, about 50 degrees.
  constexpr float kEdge = 1.2f;
  if (std::abs(a - b) < kEdge) return 0.5f * (a + b);
  return std::abs(a) < std::abs(b) ? a : b;
}

/// Mixes a colour with the grey of equal brightness; a negative share makes it more colourful.
Vec3f desaturate(const Vec3f& color, float share) {
  const float grey = color.dot(Vec3f(0.3f, 0.59f, 0.11f));
  return color + (Vec3f::Constant(grey) - color) * share;
}

/// Compares bits, because any other colour requires repainting the ground.
bool same(const std::vector<scene::Color>& a, const std::vector<scene::Color>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0);
}

/// Unites rectangles that are cheaper to update at once: those that, each with its surroundings of
/// `reach` columns, cover no fewer columns than their union does with its own.
std::vector<ColumnRect> united(std::vector<ColumnRect> rects, int reach, int nx, int ny) {
  for (std::size_t i = 0; i < rects.size(); ++i)
    for (std::size_t k = i + 1; k < rects.size();) {
      const ColumnRect both = rects[i].with(rects[k]);
      const auto cost = [&](const ColumnRect& rect) { return rect.grown(reach, nx, ny).area(); };
      if (cost(both) > cost(rects[i]) + cost(rects[k])) {
        ++k;
        continue;
      }
      // The larger rectangle may now be worth uniting with those skipped before.
      rects[i] = both;
      rects.erase(rects.begin() + static_cast<std::ptrdiff_t>(k));
      k = i + 1;
    }
  return rects;
}

}  // namespace

std::vector<ColumnRect> GroundSurface::update(const scene::FrameGround& ground,
                                              const Lighting& lighting) {
  const std::size_t n = static_cast<std::size_t>(std::max(0, ground.nx)) *
                        static_cast<std::size_t>(std::max(0, ground.ny));
  if (ground.height.size() != n || (!ground.change.empty() && ground.change.size() != n) ||
      (!ground.soil.empty() && ground.soil.size() != n) ||
      (!ground.top.empty() && ground.top.size() != n) || !(ground.cell > 0))
    throw Error("the frame's ground arrays do not have nx * ny = " + std::to_string(n) +
                " entries");
  // A change that concerns all columns starts from scratch.
  const bool fresh = nx_ != ground.nx || ny_ != ground.ny ||
                     cell_ != static_cast<float>(ground.cell) ||
                     x0_ != static_cast<float>(ground.origin.x()) ||
                     y0_ != static_cast<float>(ground.origin.y()) || !(lighting == lighting_) ||
                     !same(soil_color_, ground.soil_color) || soil_moist_ != ground.soil_moist ||
                     cut_fill_ != static_cast<float>(ground.cut_fill) || height_.size() != n;
  // A frame may be drawn several times.
  if (!fresh && revision_ == ground.revision) return {};
  const std::vector<ColumnRect> changed =
      fresh ? std::vector<ColumnRect>{{0, 0, ground.nx, ground.ny}} : changed_cells(ground);
  if (fresh) start(ground, lighting, n);
  revision_ = ground.revision;
  for (const ColumnRect& rect : changed) copy(ground, rect);
  if (fresh && n > 0) measure_relief();
  // Light depends on the ground as far as shadows reach, so all heights are updated before any
  // light is computed.
  std::vector<ColumnRect> lit;
  for (const ColumnRect& rect : united(changed, kShadowReach, nx_, ny_)) {
    if (rect.empty()) continue;
    const ColumnRect sun = rect.grown(kShadowReach, nx_, ny_);
    find_openness(rect.grown(kOpenReach, nx_, ny_));
    find_sun(sun);
    lit.push_back(sun);
  }
  for (const ColumnRect& rect : lit) paint(rect);
  return lit;
}

void GroundSurface::start(const scene::FrameGround& ground, const Lighting& lighting,
                          std::size_t columns) {
  nx_ = ground.nx;
  ny_ = ground.ny;
  cell_ = static_cast<float>(ground.cell);
  x0_ = static_cast<float>(ground.origin.x());
  y0_ = static_cast<float>(ground.origin.y());
  lighting_ = lighting;
  soil_color_ = ground.soil_color;
  soil_moist_ = ground.soil_moist;
  cut_fill_ = static_cast<float>(ground.cut_fill);
  for (std::vector<float>* heights : {&height_, &top_, &drawn_, &raw_, &raw_top_, &change_})
    heights->assign(columns, 0);
  soil_.assign(columns, 0);
  open_.assign(columns, 255);
  sun_.assign(columns, 255);
  lit_.assign(columns, {});
  // Patches depend on the place in the world, so that a moved window keeps its appearance.
  broad_.resize(columns);
  for (int iy = 0; iy < ny_; ++iy)
    for (int ix = 0; ix < nx_; ++ix) {
      const float x = x0_ + (static_cast<float>(ix) + 0.5f) * cell_,
                  y = y0_ + (static_cast<float>(iy) + 0.5f) * cell_;
      broad_[index(ix, iy)] =
          value_noise(x / 3.1f, y / 3.1f, 1) + 0.5f * value_noise(x / 1.1f, y / 1.1f, 2);
    }
}

void GroundSurface::measure_relief() {
  // Mean of the initial ground, so that digging does not change the tint of the whole site.
  double sum = 0;
  float low = raw_[0] - change_[0], high = low;
  for (std::size_t i = 0; i < raw_.size(); ++i) {
    const float h = raw_[i] - change_[i];
    sum += h;
    low = std::min(low, h);
    high = std::max(high, h);
  }
  mean_height_ = static_cast<float>(sum / static_cast<double>(raw_.size()));
  relief_ = std::max(high - low, 2.0f);
}

std::vector<ColumnRect> GroundSurface::changed_cells(const scene::FrameGround& ground) const {
  // Frames in between were skipped and their rectangles are unknown, so the heights themselves are
  // compared.
  if (ground.revision != revision_ + 1) return {compared(ground)};
  std::vector<ColumnRect> reported;
  for (const scene::FrameRect& rect : ground.changed)
    reported.push_back({std::max(0, rect.x0), std::max(0, rect.y0), std::min(nx_, rect.x1),
                        std::min(ny_, rect.y1)});
  std::erase_if(reported, [](const ColumnRect& rect) { return rect.empty(); });
  return reported;
}

bool GroundSurface::differs(const scene::FrameGround& ground, std::size_t i) const {
  return raw_[i] != ground.height[i] ||
         (!ground.change.empty() && change_[i] != ground.change[i]) ||
         (!ground.soil.empty() && soil_[i] != ground.soil[i]) ||
         (!ground.top.empty() && raw_top_[i] != ground.top[i]);
}

ColumnRect GroundSurface::compared(const scene::FrameGround& ground) const {
  ColumnRect rect = {nx_, ny_, 0, 0};
  // Compares whole rows first, as most are equal.
  for (int iy = 0; iy < ny_; ++iy) {
    const std::size_t row = index(0, iy), width = static_cast<std::size_t>(nx_);
    const auto equal = [&](const auto& copy, const auto& now) {
      return now.empty() || std::memcmp(&copy[row], &now[row], width * sizeof now[0]) == 0;
    };
    if (equal(raw_, ground.height) && equal(change_, ground.change) && equal(soil_, ground.soil) &&
        equal(raw_top_, ground.top))
      continue;
    rect.y0 = std::min(rect.y0, iy);
    rect.y1 = iy + 1;
    for (int ix = 0; ix < nx_; ++ix) {
      if (!differs(ground, index(ix, iy))) continue;
      rect.x0 = std::min(rect.x0, ix);
      rect.x1 = std::max(rect.x1, ix + 1);
    }
  }
  return rect;
}

void GroundSurface::copy(const scene::FrameGround& ground, const ColumnRect& rect) {
  for (int iy = rect.y0; iy < rect.y1; ++iy)
    for (int ix = rect.x0; ix < rect.x1; ++ix) {
      const std::size_t i = index(ix, iy);
      // A missing height must not spoil the shadows around it.
      const auto finite = [](float height) { return std::isfinite(height) ? height : 0.0f; };
      raw_[i] = height_[i] = drawn_[i] = finite(ground.height[i]);
      raw_top_[i] = top_[i] = ground.top.empty() ? raw_[i] : finite(ground.top[i]);
      if (!ground.change.empty()) change_[i] = ground.change[i];
      if (!ground.soil.empty()) soil_[i] = ground.soil[i];
    }
  if (!smooth_) return;
  const ColumnRect around = rect.grown(kSmoothReach, nx_, ny_);
  for (int iy = around.y0; iy < around.y1; ++iy)
    for (int ix = around.x0; ix < around.x1; ++ix) smooth(ix, iy);
  const ColumnRect wider = around.grown(1, nx_, ny_);
  for (int iy = wider.y0; iy < wider.y1; ++iy)
    for (int ix = wider.x0; ix < wider.x1; ++ix) bury(ix, iy);
}

void GroundSurface::bury(int ix, int iy) {
  const std::size_t i = index(ix, iy);
  drawn_[i] = height_[i];
  if (top_[i] <= height_[i]) return;
  // Not above any neighbour: beside a step, a column is not covered on all sides.
  float least = top_[i] - kBuried * cell_;
  for (int y = std::max(0, iy - 1); y <= std::min(ny_ - 1, iy + 1); ++y)
    for (int x = std::max(0, ix - 1); x <= std::min(nx_ - 1, ix + 1); ++x)
      least = std::min(least, top_[index(x, y)]);
  drawn_[i] = std::max(height_[i], least);
}

void GroundSurface::smooth(int ix, int iy) {
  const std::size_t i = index(ix, iy);
  height_[i] = raw_[i];
  top_[i] = raw_top_[i];
  if (ix < kSmoothReach || iy < kSmoothReach || ix + kSmoothReach >= nx_ ||
      iy + kSmoothReach >= ny_)
    return;
  float most = 0;
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      const std::size_t k = index(ix + dx, iy + dy);
      most = std::max(most, change_[k] + raw_top_[k] - raw_[k]);
    }
  // Only where soil was dumped; cuts and the old ground keep their edges.
  const float share = smooth_step(0.01f, 0.05f, most);
  if (share <= 0) return;
  constexpr std::array<float, 2 * kSmoothReach + 1> kBinomial = {1.0f / 16, 4.0f / 16, 6.0f / 16,
                                                                 4.0f / 16, 1.0f / 16};
  float top = 0;
  for (int dy = -kSmoothReach; dy <= kSmoothReach; ++dy)
    for (int dx = -kSmoothReach; dx <= kSmoothReach; ++dx)
      top += kBinomial[static_cast<std::size_t>(dx + kSmoothReach)] *
             kBinomial[static_cast<std::size_t>(dy + kSmoothReach)] *
             raw_top_[index(ix + dx, iy + dy)];
  const float rise = share * (top - raw_top_[i]);
  top_[i] += rise;
  // Columns below active soil are covered by it. Beside them, their low heights would draw a groove
  // around soil that came to rest.
  if (raw_top_[i] == raw_[i]) height_[i] += rise;
}

// Share of the sky that a column sees, from the mean height around it: a box mean by running sums
// along x, then y.
void GroundSurface::find_openness(const ColumnRect& rect) {
  const int width = rect.x1 - rect.x0;
  const ColumnRect tall = {rect.x0, std::max(0, rect.y0 - kOpenReach), rect.x1,
                           std::min(ny_, rect.y1 + kOpenReach)};
  // Sums along x of the rows that the sums along y need.
  scratch_.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(tall.y1 - tall.y0));
  for (int iy = tall.y0; iy < tall.y1; ++iy) {
    float* out =
        &scratch_[static_cast<std::size_t>(iy - tall.y0) * static_cast<std::size_t>(width)];
    const float* row = &top_[index(0, iy)];
    for (int ix = rect.x0; ix < rect.x1; ++ix) {
      float sum = 0;
      for (int k = -kOpenReach; k <= kOpenReach; ++k) sum += row[std::clamp(ix + k, 0, nx_ - 1)];
      out[ix - rect.x0] = sum * (1.0f / (2 * kOpenReach + 1));
    }
  }
  for (int iy = rect.y0; iy < rect.y1; ++iy)
    for (int ix = rect.x0; ix < rect.x1; ++ix) {
      float sum = 0;
      for (int k = -kOpenReach; k <= kOpenReach; ++k) {
        const int y = std::clamp(iy + k, 0, ny_ - 1) - tall.y0;
        sum += scratch_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                        static_cast<std::size_t>(ix - rect.x0)];
      }
      const float above = sum * (1.0f / (2 * kOpenReach + 1)) - top_[index(ix, iy)];
      // Mean slope upwards to the surroundings.
      const float hidden = above / (cell_ * kOpenReach);
      open_[index(ix, iy)] = to_byte(std::clamp(0.90f - 0.55f * hidden, 0.35f, 1.0f));
    }
}

// Share of the sun that a column sees: the highest ground towards the sun compared with the ray,
// softened over the (widened) disc of the sun.
void GroundSurface::find_sun(const ColumnRect& rect) {
  const Vec3f& to_sun = lighting_.to_sun;
  const float flat = to_sun.head<2>().norm();
  // With the sun overhead the ground casts no shadow.
  if (flat < 1e-3f) {
    for (int iy = rect.y0; iy < rect.y1; ++iy)
      for (int ix = rect.x0; ix < rect.x1; ++ix) sun_[index(ix, iy)] = 255;
    return;
  }
  // Steps towards the sun in the plane, and the rise of the ray per step.
  const float dx = to_sun.x() / flat, dy = to_sun.y() / flat, rise = to_sun.z() / flat;
  for (int iy = rect.y0; iy < rect.y1; ++iy)
    for (int ix = rect.x0; ix < rect.x1; ++ix) {
      const float base = top_[index(ix, iy)];
      // Samples every column nearby and every second one farther off: distant ground moves the edge
      // of a shadow less.
      float worst = -1e9f;
      for (int k = 1; k <= kShadowReach; k += k < 8 ? 1 : 2) {
        const float d = static_cast<float>(k);
        const int x = ix + static_cast<int>(std::lround(dx * d)),
                  y = iy + static_cast<int>(std::lround(dy * d));
        if (x < 0 || y < 0 || x >= nx_ || y >= ny_) break;
        const float run = d * cell_;
        worst = std::max(worst, (top_[index(x, y)] - base) / run - rise);
      }
      sun_[index(ix, iy)] = to_byte(1.0f - smooth_step(-0.06f, 0.22f, worst));
    }
}

Vec3f GroundSurface::normal(int ix, int iy) const {
  // One-sided at the edge of the site.
  const float h = top_[index(ix, iy)], inverse = 1.0f / cell_;
  const float west = ix > 0 ? (h - top_[index(ix - 1, iy)]) * inverse : 0;
  const float east = ix + 1 < nx_ ? (top_[index(ix + 1, iy)] - h) * inverse : west;
  const float south = iy > 0 ? (h - top_[index(ix, iy - 1)]) * inverse : 0;
  const float north = iy + 1 < ny_ ? (top_[index(ix, iy + 1)] - h) * inverse : south;
  return Vec3f(-edge_slope(ix > 0 ? west : east, east), -edge_slope(iy > 0 ? south : north, north),
               1)
      .normalized();
}

Vec3f GroundSurface::base_color(std::uint8_t soil) const {
  if (soil >= soil_color_.size()) return {0.50f, 0.40f, 0.28f};
  return {soil_color_[soil].r, soil_color_[soil].g, soil_color_[soil].b};
}

Vec3f GroundSurface::albedo(int ix, int iy) const {
  const std::size_t i = index(ix, iy);
  const float fine =
      2.0f * hash_unit(static_cast<std::uint32_t>(ix), static_cast<std::uint32_t>(iy), 7) - 1.0f;
  return weathered(soil_[i], top_[i], change_[i] + raw_top_[i] - raw_[i], broad_[i], fine);
}

Vec3f GroundSurface::weathered(std::uint8_t soil, float height, float change, float broad,
                               float fine) const {
  const Vec3f base = base_color(soil);
  // The old surface: dry, dusty, patchy, a little lighter with height.
  const float tint = std::clamp((height - mean_height_) / relief_, -0.5f, 0.5f);
  Vec3f color = desaturate(base, 0.28f) * (1.07f + 0.09f * broad + 0.03f * fine + 0.14f * tint);
  // Freshly cut soil that holds water is darker and more colourful; dumped soil is loose, lighter
  // and uneven. Both begin above the roughness of the ground, or wheels would leave stains.
  const float dug = smooth_step(0.015f, 0.09f, -change), dumped = smooth_step(0.02f, 0.09f, change);
  const bool moist = soil >= soil_moist_.size() || soil_moist_[soil] != 0;
  const Vec3f fresh = moist
                          ? Vec3f(desaturate(base, -0.18f) * (0.66f + 0.03f * broad + 0.03f * fine))
                          : Vec3f(desaturate(base, 0.10f) * (0.98f + 0.05f * broad + 0.03f * fine));
  const Vec3f loose = desaturate(base, 0.05f) * (0.90f + 0.04f * broad + 0.06f * fine);
  color += (fresh - color) * dug;
  color += (loose - color) * dumped;
  if (cut_fill_ > 0) {
    // Below a hundredth of the scale the ground counts as untouched.
    const float share = smooth_step(0.01f, 1.0f, std::abs(change) / cut_fill_);
    const Vec3f mark = change < 0 ? Vec3f(0.85f, 0.10f, 0.08f) : Vec3f(0.10f, 0.25f, 0.85f);
    if (share > 0) color += (mark - color) * (0.25f + 0.65f * share);
  }
  return color.cwiseMax(0.0f);
}

Vec3f GroundSurface::loose_albedo(const Vec3f& p, std::uint8_t soil) const {
  const int ix = static_cast<int>(std::floor((p.x() - x0_) / cell_)),
            iy = static_cast<int>(std::floor((p.y() - y0_) / cell_));
  if (ix < 0 || iy < 0 || ix >= nx_ || iy >= ny_) return base_color(soil);
  const std::size_t i = index(ix, iy);
  const auto grain = [](float x) { return static_cast<std::uint32_t>(static_cast<int>(x * 40)); };
  const float fine = 2.0f * hash_unit(grain(p.x()), grain(p.y()), grain(p.z())) - 1.0f;
  // Soil far above the ground is in a bucket or falls: freshly dug.
  constexpr float kInTheAir = 0.3f, kFresh = -0.06f;
  const float change = p.z() > top_[i] + kInTheAir ? kFresh : p.z() - (raw_[i] - change_[i]);
  return weathered(soil, p.z(), change, broad_[i], fine);
}

void GroundSurface::paint(const ColumnRect& rect) {
  for (int iy = rect.y0; iy < rect.y1; ++iy)
    for (int ix = rect.x0; ix < rect.x1; ++ix) {
      const std::size_t i = index(ix, iy);
      const float sun = static_cast<float>(sun_[i]) / 255.0f,
                  open = static_cast<float>(open_[i]) / 255.0f;
      const Vec3f color = shade(lighting_, albedo(ix, iy), normal(ix, iy), sun, open);
      lit_[i] = {to_byte(color.x()), to_byte(color.y()), to_byte(color.z()), 255};
    }
}

Vec3f GroundSurface::wall_color(int ix, int iy, const Vec3f& face) const {
  const std::size_t i = index(ix, iy);
  const Vec3f base = base_color(soil_[i]);
  const float fine = hash_unit(static_cast<std::uint32_t>(ix), static_cast<std::uint32_t>(iy), 9);
  const Vec3f moist = desaturate(base, -0.15f) * (0.70f + 0.10f * fine);
  return shade(lighting_, moist, face, static_cast<float>(sun_[i]) / 255.0f,
               static_cast<float>(open_[i]) / 255.0f);
}

bool GroundSurface::sample(float x, float y, float& height, float& sun) const {
  // Uses the nearest column: callers place particles, which are larger than the difference.
  if (nx_ < 2 || ny_ < 2) return false;
  const float u = (x - x0_) / cell_ - 0.5f, v = (y - y0_) / cell_ - 0.5f;
  const int ix = static_cast<int>(std::floor(u + 0.5f)),
            iy = static_cast<int>(std::floor(v + 0.5f));
  if (ix < 0 || iy < 0 || ix >= nx_ || iy >= ny_) return false;
  height = top_[index(ix, iy)];
  sun = static_cast<float>(sun_[index(ix, iy)]) / 255.0f;
  return true;
}

GroundSurface::Around GroundSurface::around(float x, float y) const {
  const float u = std::clamp((x - x0_) / cell_ - 0.5f, 0.0f, static_cast<float>(nx_) - 1.001f);
  const float v = std::clamp((y - y0_) / cell_ - 0.5f, 0.0f, static_cast<float>(ny_) - 1.001f);
  const int ix = static_cast<int>(u), iy = static_cast<int>(v);
  const float fx = u - static_cast<float>(ix), fy = v - static_cast<float>(iy);
  const std::size_t first = index(ix, iy), next = index(ix, iy + 1);
  return {{first, first + 1, next, next + 1},
          {(1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy}};
}

ColumnShares GroundSurface::columns_at(float x, float y) const {
  const Around at = around(x, y);
  ColumnShares out;
  out.share = at.share;
  for (std::size_t c = 0; c < 4; ++c) out.height[c] = height_[at.index[c]];
  return out;
}

GroundLook GroundSurface::look_at(float x, float y) const {
  const Around at = around(x, y);
  GroundLook out;
  float low = 1e30f, high = -1e30f;
  for (std::size_t c = 0; c < 4; ++c) {
    const float top = top_[at.index[c]];
    const auto& lit = lit_[at.index[c]];
    out.height += at.share[c] * top;
    out.color += (at.share[c] / 255.0f) * Vec3f(lit[0], lit[1], lit[2]);
    low = std::min(low, top);
    high = std::max(high, top);
  }
  out.range = high - low;
  return out;
}

}  // namespace navvy::render
