// SPDX-License-Identifier: Apache-2.0
#include "control/activities/press_places.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/polygon.h"

namespace navvy::control {
namespace {

constexpr double kEven = 0.02;     // height within which a bottom counts as flat [m]
constexpr double kOverlap = 0.05;  // of neighbouring places [m]
constexpr double kSample = 0.05;   // distance of the points that are to be covered [m]
// Largest angle of the bottom on the ground [rad].
constexpr double kAskew = radians(3);

/// A point in polar coordinates about the swing axis; the angle is from the middle of the polygon.
struct Polar {
  double r = 0, angle = 0;
};

/// Returns points of a polygon, its corners among them.
std::vector<Vec2> points_in(const std::vector<Vec2>& polygon) {
  Vec2 low = polygon.front(), high = low;
  for (const Vec2& p : polygon) low = low.cwiseMin(p), high = high.cwiseMax(p);
  std::vector<Vec2> out = polygon;
  const auto nx = static_cast<int>((high.x() - low.x()) / kSample) + 1,
             ny = static_cast<int>((high.y() - low.y()) / kSample) + 1;
  for (int iy = 0; iy < ny; ++iy)
    for (int ix = 0; ix < nx; ++ix) {
      const Vec2 p = low + kSample * Vec2(ix + 0.5, iy + 0.5);
      if (scene::contains(polygon, p)) out.push_back(p);
    }
  return out;
}

/// Returns the middles of equal intervals of width `wide` that cover the interval from `low` to
/// `high` and overlap by at least `overlap`.
std::vector<double> middles(double low, double high, double wide, double overlap) {
  const double more = std::max(0.0, high - low - wide);
  const int n = 1 + static_cast<int>(std::ceil(more / (wide - overlap) - 1e-9));
  std::vector<double> out;
  out.reserve(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i)
    out.push_back(n == 1 ? 0.5 * (low + high) : low + 0.5 * wide + i * more / (n - 1));
  return out;
}

}  // namespace

FlatBottom flat_bottom(const ArmKinematics& arm) {
  FlatBottom out;
  out.width = arm.bucket().width;
  // Near the angle at which the cutting edge is level; the heel may have to be lower.
  const double level = with_cut(arm, -kPi);
  for (double angle = level - radians(20); angle <= level + radians(10); angle += radians(0.5)) {
    if (arm.below_tip(angle) > kEven) continue;
    const double length = arm.beyond_tip(angle, kEven);
    if (length > out.length) out.angle = angle, out.length = length;
  }
  return out;
}

std::vector<Vec2> press_places(const std::vector<Vec2>& polygon, const Vec2& axis,
                               const FlatBottom& bottom) {
  std::vector<Vec2> out;
  if (polygon.size() < 3 || !(std::min(bottom.length, bottom.width) > 2 * kOverlap)) return out;
  const std::vector<Vec2> points = points_in(polygon);
  Vec2 middle = Vec2::Zero();
  for (const Vec2& p : points) middle += p / static_cast<double>(points.size());
  const double ahead = std::atan2(middle.y() - axis.y(), middle.x() - axis.x());
  std::vector<Polar> polar;
  double near = std::numeric_limits<double>::infinity(), far = 0;
  for (const Vec2& p : points) {
    const Vec2 d = p - axis;
    polar.push_back({d.norm(), std::remainder(std::atan2(d.y(), d.x()) - ahead, 2 * kPi)});
    near = std::min(near, polar.back().r);
    far = std::max(far, polar.back().r);
  }
  bool back = false;
  for (const double r : middles(near, far, bottom.length, kOverlap)) {
    // Side by side where the ring is widest.
    const double outer = r + 0.5 * bottom.length;
    const auto angle_of = [&](double width) {
      return 2 * std::asin(std::min(1.0, 0.5 * width / outer));
    };
    const double wide = angle_of(bottom.width);
    std::vector<double> here;
    for (const Polar& p : polar)
      if (std::abs(p.r - r) <= 0.5 * bottom.length) here.push_back(p.angle);
    if (here.empty()) continue;
    const auto [low, high] = std::minmax_element(here.begin(), here.end());
    std::vector<double> angles =
        middles(*low, *high, wide, wide - angle_of(bottom.width - kOverlap));
    if (back) std::reverse(angles.begin(), angles.end());
    back = !back;
    for (const double angle : angles)
      if (std::any_of(here.begin(), here.end(),
                      [&](double a) { return std::abs(a - angle) <= 0.5 * wide; }))
        out.push_back(axis + r * Vec2(std::cos(ahead + angle), std::sin(ahead + angle)));
  }
  return out;
}

double ground_under(const SurfaceView& surface, const Vec2& place, const Vec2& axis,
                    const FlatBottom& bottom) {
  const Vec2 out = (place - axis).normalized(), across(-out.y(), out.x());
  double highest = -std::numeric_limits<double>::infinity();
  for (const double along : {-0.5, -0.25, 0.0, 0.25, 0.5})
    for (const double aside : {-0.5, -0.25, 0.0, 0.25, 0.5}) {
      const Vec2 p = place + along * bottom.length * out + aside * bottom.width * across;
      highest = std::max(highest, surface.height(p.x(), p.y()));
    }
  return highest;
}

bool can_press_at(const ArmKinematics& arm, const FlatBottom& bottom, const SwingPoint& tip) {
  BucketPose pose{tip.reach, tip.height, tip.level(bottom.angle)};
  ArmAngles q;
  return arm.inverse_nearest(pose, q) && std::abs(pose.angle - tip.level(bottom.angle)) <= kAskew;
}

}  // namespace navvy::control
