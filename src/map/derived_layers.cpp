// SPDX-License-Identifier: Apache-2.0
// Sums run in one fixed order and in double, so that the bits depend on the columns alone and not
// on the rectangle that is computed.
#include "map/derived_layers.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "map/terrain_map.h"

namespace navvy::map {
namespace {

// Largest window [columns to each side]: one of 129 x 129 costs a tenth of a millisecond per
// column.
constexpr int kWidestReach = 64;

/// Returns false for NaN, the one number that differs from itself.
bool known(float value) { return value == value; }

/// Returns the height gained per column along one axis; NaN where neither neighbour is known.
double gradient(float before, float here, float after) {
  const auto z = static_cast<double>(here);
  if (known(before) && known(after))
    return (static_cast<double>(after) - static_cast<double>(before)) / 2;
  if (known(after)) return static_cast<double>(after) - z;
  if (known(before)) return z - static_cast<double>(before);
  return static_cast<double>(kUnknown);
}

}  // namespace

// The minimum guards against the overflow of a window that is huge or not finite.
int TraversabilityLimits::reach(double cell) const {
  return std::clamp(static_cast<int>(std::lround(std::min(window / cell, 1e6))), 1, kWidestReach);
}

// The largest window bounds the cost of an update.
void TraversabilityLimits::require_valid(double cell) const {
  const auto check = [](const char* name, double value, double most, const char* remedy) {
    if (std::isfinite(value) && value > 0 && value <= most) return;
    throw InputError(Fault{Fault::Severity::kError, "", 0, std::string("traversability ") + name,
                           std::to_string(value), "above 0, at most " + std::to_string(most),
                           remedy});
  };
  check("slope", slope, kPi / 2, "the steepest slope to drive on, in radians");
  check("step height", step_height, 1e6, "the highest step to drive over, in metres");
  check("roughness", roughness, 1e6, "the largest rms roughness to drive on, in metres");
  check("window", window, kWidestReach * cell, "half the side of the square looked at, in metres");
}

Vec2 gradient_at(const ElevationPatch& patch, int ix, int iy) {
  // An unknown column has no gradient, however well known its neighbours are.
  const float z = patch.at(ix, iy);
  if (!known(z)) return Vec2::Constant(std::nan(""));
  return {gradient(patch.at(ix - 1, iy), z, patch.at(ix + 1, iy)) / patch.cell,
          gradient(patch.at(ix, iy - 1), z, patch.at(ix, iy + 1)) / patch.cell};
}

float slope_at(const ElevationPatch& patch, int ix, int iy) {
  const Vec2 g = gradient_at(patch, ix, iy);
  const double steep = std::sqrt(g.x() * g.x() + g.y() * g.y());
  return steep == steep ? static_cast<float>(std::atan(steep)) : kUnknown;
}

// A step is a height between neighbours, so the window takes the largest of many small differences
// and never the range over a long slope.
float step_height_at(const ElevationPatch& patch, int ix, int iy, int reach) {
  if (!known(patch.at(ix, iy))) return kUnknown;
  // Visits each pair once, from its column with less x or y; the maximum depends on no order.
  float most = 0;
  for (int y = iy - reach; y <= iy + reach; ++y)
    for (int x = ix - reach; x <= ix + reach; ++x) {
      const float z = patch.at(x, y);
      // A comparison with an unknown neighbour is false.
      if (x < ix + reach && std::abs(patch.at(x + 1, y) - z) > most)
        most = std::abs(patch.at(x + 1, y) - z);
      if (y < iy + reach && std::abs(patch.at(x, y + 1) - z) > most)
        most = std::abs(patch.at(x, y + 1) - z);
    }
  return most;
}

// A plane has no roughness at any slope, because the residuals count from the fitted plane.
PlaneFit plane_at(const ElevationPatch& patch, int ix, int iy, int reach) {
  const float centre = patch.at(ix, iy);
  if (!known(centre)) return {};
  // Moments about the column itself, where numbers are small.
  double n = 0, sx = 0, sy = 0, sz = 0, sxx = 0, sxy = 0, syy = 0, sxz = 0, syz = 0, szz = 0;
  for (int y = -reach; y <= reach; ++y)
    for (int x = -reach; x <= reach; ++x) {
      const float value = patch.at(ix + x, iy + y);
      if (!known(value)) continue;
      const double z = static_cast<double>(value) - static_cast<double>(centre);
      n += 1, sx += x, sy += y, sz += z;
      sxx += x * x, sxy += x * y, syy += y * y, sxz += x * z, syz += y * z, szz += z * z;
    }
  // About their means; then the plane's two slopes by Cramer's rule.
  sxx -= sx * sx / n, sxy -= sx * sy / n, syy -= sy * sy / n;
  sxz -= sx * sz / n, syz -= sy * sz / n, szz -= sz * sz / n;
  const double det = sxx * syy - sxy * sxy;
  if (!(det > 1e-9 * sxx * syy)) return {};
  // Fewer than three known columns, or all in one line, determine no plane: refused above.
  const double a = (sxz * syy - syz * sxy) / det, b = (syz * sxx - sxz * sxy) / det;
  return {static_cast<float>(std::atan(std::sqrt(a * a + b * b) / patch.cell)),
          static_cast<float>(std::sqrt(std::max(szz - a * sxz - b * syz, 0.0) / n))};
}

// The mean ranks ground that is drivable; a single limit that is reached makes it undrivable.
float traversability(float inclination, float step_height, float roughness,
                     const TraversabilityLimits& limits) {
  // Added in this order always. A good slope does not make up for a step that is too high.
  double sum = 0;
  bool bad = false;
  for (const auto& [value, limit] :
       {std::pair{inclination, limits.slope}, std::pair{step_height, limits.step_height},
        std::pair{roughness, limits.roughness}}) {
    if (!known(value)) return kUnknown;
    const double share = static_cast<double>(value) / limit;
    bad = bad || share >= 1;
    sum += 1 - share;
  }
  return bad ? 0.0f : static_cast<float>(sum / 3);
}

float Surround::slope() { return slope_at(patch_, ix_, iy_); }

// The two values below are kept, because traversability needs them again.

float Surround::step_height() {
  if (!step_height_) step_height_ = step_height_at(patch_, ix_, iy_, reach_);
  return *step_height_;
}

const PlaneFit& Surround::plane() {
  if (!plane_) plane_ = plane_at(patch_, ix_, iy_, reach_);
  return *plane_;
}

float Surround::normal(int axis) const {
  const Vec2 g = gradient_at(patch_, ix_, iy_);
  return static_cast<float>(Vec3(-g.x(), -g.y(), 1).normalized()[axis]);
}

}  // namespace navvy::map
