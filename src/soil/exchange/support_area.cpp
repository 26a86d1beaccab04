// SPDX-License-Identifier: Apache-2.0
#include "soil/exchange/support_area.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace navvy::soil {
namespace {

constexpr double kNowhere = std::numeric_limits<double>::infinity();
/// Columns around the rim that count with it [cells]: a tyre stands on the ground between two of
/// them, and no standing edge may reach under it.
constexpr double kAround = 1;
/// Distance below the rim at which ground counts as met [cells]: more than a rut sinks between two
/// checks.
constexpr double kNear = 0.25;

double slope(const Vec3& direction) {
  const double plan = direction.head<2>().norm();
  return plan > 0 ? direction.z() / plan : 0;
}

}  // namespace

SupportPlacement::SupportPlacement(const SupportArea& area, const heightfield::Ground& ground,
                                   double interval)
    : area_(area), origin_(ground.origin()), cell_(ground.cell()) {
  ahead_ = area.ahead_W.head<2>().normalized();
  left_ = Vec2(-ahead_.y(), ahead_.x());
  // As ruts do: a narrow tyre stands on the ground between the columns to either side of it.
  area_.half_width = std::max(area.half_width, cell_);
  const double time = interval + area.ready;
  travel_ = time * area.v_W.head<2>().dot(ahead_);
  fall_ = time * std::max(0.0, -area.v_W.z()) + kNear * cell_;
  const double along = area.half_run + area.radius + kAround * cell_;
  const double across = area_.half_width + kAround * cell_;
  Vec2 low = Vec2::Constant(kNowhere), high = -low;
  for (const double x : {std::min(travel_, 0.0) - along, std::max(travel_, 0.0) + along})
    for (const double y : {-across, across}) {
      const Vec2 corner = area.p_W.head<2>() + x * ahead_ + y * left_;
      low = low.cwiseMin(corner);
      high = high.cwiseMax(corner);
    }
  const Vec2i first = ground.column_at(low.x(), low.y()),
              last = ground.column_at(high.x(), high.y());
  rect_ = {std::max(first.x(), 0), std::max(first.y(), 0), std::min(last.x() + 1, ground.nx()),
           std::min(last.y() + 1, ground.ny())};
}

Vec2 SupportPlacement::along_across(int ix, int iy) const {
  const Vec2 d = origin_ + cell_ * Vec2(ix + 0.5, iy + 0.5) - area_.p_W.head<2>();
  return {d.dot(ahead_), d.dot(left_)};
}

double SupportPlacement::underside(double along, double across, double widened) const {
  const double aside = std::max(0.0, std::abs(across) - widened);
  const double out = std::max(0.0, std::abs(along) - area_.half_run - widened);
  if (aside > area_.half_width || out >= area_.radius) return kNowhere;
  return area_.p_W.z() + slope(area_.ahead_W) * std::clamp(along, -area_.half_run, area_.half_run) +
         slope(area_.left_W) * std::clamp(across, -area_.half_width, area_.half_width) -
         std::sqrt(area_.radius * area_.radius - out * out);
}

bool SupportPlacement::meets(int ix, int iy, double height) const {
  const Vec2 at = along_across(ix, iy);
  // The closest position of the middle during its travel.
  const double along = at.x() - std::clamp(at.x(), std::min(travel_, 0.0), std::max(travel_, 0.0));
  return height > underside(along, at.y(), kAround * cell_) - fall_;
}

double SupportPlacement::height_limit(int ix, int iy) const {
  const Vec2 at = along_across(ix, iy);
  return underside(at.x(), at.y(), 0) + area_.flattening;
}

std::vector<SupportPlacement> support_placements(std::span<const SupportArea> support_areas,
                                                 const heightfield::Ground& ground,
                                                 double interval) {
  std::vector<SupportPlacement> out;
  out.reserve(support_areas.size());
  for (const SupportArea& area : support_areas) out.emplace_back(area, ground, interval);
  return out;
}

}  // namespace navvy::soil
