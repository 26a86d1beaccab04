// SPDX-License-Identifier: Apache-2.0
#include "planner/footprint.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "core/error.h"
#include "vehicle/collision_box.h"

namespace navvy::planner {
namespace {

/// A rectangle in its own axes around its centre.
struct Box {
  Vec2 middle;
  Vec2 half;
  /// Unit vector of its x axis.
  Vec2 ax;
  Vec2 local(const Vec2& p) const {
    const Vec2 d = p - middle;
    return {ax.dot(d), ax.x() * d.y() - ax.y() * d.x()};
  }
  std::array<Vec2, 4> corners() const {
    const Vec2 ay(-ax.y(), ax.x());
    const Vec2 a = half.x() * ax, b = half.y() * ay;
    return {middle - a - b, middle + a - b, middle + a + b, middle - a + b};
  }
  /// Returns the distance of a point; 0 inside.
  double distance(const Vec2& p) const { return (local(p).cwiseAbs() - half).cwiseMax(0).norm(); }
};

/// Returns true when a line along an axis of `a` separates the two.
bool apart(const Box& a, const Box& b) {
  Vec2 low = Vec2::Constant(INFINITY), high = -low;
  for (const Vec2& corner : b.corners()) {
    low = low.cwiseMin(a.local(corner));
    high = high.cwiseMax(a.local(corner));
  }
  return (low.array() > a.half.array()).any() || (high.array() < -a.half.array()).any();
}

/// Returns the distance of two rectangles: 0 when they overlap, else from a corner of one to the
/// other.
double distance(const Box& a, const Box& b) {
  if (!apart(a, b) && !apart(b, a)) return 0;
  double least = INFINITY;
  for (const Vec2& corner : a.corners()) least = std::min(least, b.distance(corner));
  for (const Vec2& corner : b.corners()) least = std::min(least, a.distance(corner));
  return least;
}

/// Returns true when all values are above `least`; unknown values are not. The loop has no early
/// exit, so that compilers vectorise it.
bool all_above(const float* row, int count, float least) {
  int bad = 0;
  for (int k = 0; k < count; ++k) bad |= static_cast<int>(!(row[k] > least));
  return bad == 0;
}

// A range that is not finite would walk over the whole plane.
void require_valid(const Footprint& f, double x, double y, double yaw, double range) {
  const auto fault = [](const char* name, double value, const char* rule) {
    throw InputError(Fault{Fault::Severity::kError, "", 0, std::string("clearance ") + name,
                           std::to_string(value), rule,
                           "lengths in metres from the reference point"});
  };
  for (const auto& [name, value] :
       {std::pair{"front", f.front}, std::pair{"rear", f.rear}, std::pair{"left", f.left},
        std::pair{"right", f.right}, std::pair{"range", range}})
    if (!(value >= 0 && value <= 1000)) fault(name, value, "0 to 1000 m");
  for (const auto& [name, value] : {std::pair{"x", x}, std::pair{"y", y}, std::pair{"yaw", yaw}})
    if (!(std::abs(value) <= 1e7)) fault(name, value, "a finite place");
}

}  // namespace

// Wheels count in their straight position; the box of a collision shape is turned into the axes of
// the base.
Footprint footprint_of(const scene::Machine& machine) {
  Vec3 low = Vec3::Constant(INFINITY), high = -low;
  const auto extend = [&](const Pose& X_BO, const Vec3& half) {
    const Vec3 reach = X_BO.linear().cwiseAbs() * half;
    low = low.cwiseMin(X_BO.translation() - reach);
    high = high.cwiseMax(X_BO.translation() + reach);
  };
  if (!machine.links.empty()) {
    const Pose X_BM = machine.links[0].X_ML.inverse();
    for (const scene::Collision& collision : machine.links[0].collisions)
      if (const auto box = vehicle::box_of(collision)) extend(box->X_WO, box->half);
    for (const scene::Wheel& wheel : machine.wheels)
      if (const auto around = vehicle::box_of(machine, wheel))
        extend(X_BM * machine.links[around->link].X_ML, around->box.half);
  }
  if (!(low.x() <= high.x()))
    throw InputError(
        Fault{Fault::Severity::kError, machine.file, 0, machine.name, "",
              "a machine without wheels and collision shapes of its base has no footprint",
              "add a <collision> to its base link"});
  // The reference point may lie outside, but the rectangle around it is what matters.
  return {std::max(0.0, high.x()), std::max(0.0, -low.x()), std::max(0.0, high.y()),
          std::max(0.0, -low.y())};
}

// Walks the columns under the footprint grown by the range, row by row, and lowers `best` as it
// finds bad ones.
double clearance(const map::TerrainMap& map, const Footprint& footprint, double x, double y,
                 double yaw, double range, float least) {
  require_valid(footprint, x, y, yaw, range);
  const Vec2 ax(std::cos(yaw), std::sin(yaw)), ay(-ax.y(), ax.x());
  Box body{Vec2(x, y), Vec2(footprint.front + footprint.rear, footprint.left + footprint.right) / 2,
           ax};
  body.middle +=
      ax * (footprint.front - footprint.rear) / 2 + ay * (footprint.left - footprint.right) / 2;
  // In units of the cell, counted from the corner of the site, the edges of columns are integers.
  const double cell = map.cell();
  const Vec2 extent =
      ax.cwiseAbs() * body.half.x() + ay.cwiseAbs() * body.half.y() + Vec2(range, range);
  const Vec2 low = (body.middle - extent - map.origin()) / cell,
             high = (body.middle + extent - map.origin()) / cell;
  // Distance from the centre of a column to its corners.
  const double corner = cell * std::sqrt(0.5);
  double best = range;
  const map::LayerTiles& tiles = map.tiles(map::MapLayer::kTraversability);
  const auto look = [&](int ix, int iy) {
    const Vec2 centre = map.origin() + cell * Vec2(ix + 0.5, iy + 0.5);
    // The distance of the centre rules out most columns.
    if (body.distance(centre) - corner >= best) return;
    best = std::min(best, distance(body, Box{centre, Vec2(cell, cell) / 2, Vec2(1, 0)}));
  };
  const auto last =
      Vec2i(static_cast<int>(std::floor(high.x())), static_cast<int>(std::floor(high.y())));
  for (int iy = static_cast<int>(std::floor(low.y())); iy <= last.y() && best > 0; ++iy)
    for (int ix = static_cast<int>(std::floor(low.x())), count = 1; ix <= last.x() && best > 0;
         ix += count) {
      count = 1;
      // Columns outside the site are unknown.
      const bool inside = map.contains(ix, iy) && !tiles.empty();
      const float* row = inside ? tiles.row(ix, iy, count) : nullptr;
      if (inside) count = std::min({count, last.x() - ix + 1, map.nx() - ix});
      // Most rows hold no bad column.
      if (row != nullptr && all_above(row, count, least)) continue;
      // An unknown value is treated as bad: the comparison is false.
      for (int k = 0; k < count; ++k)
        if (row == nullptr || !(row[k] > least)) look(ix + k, iy);
    }
  return best;
}

}  // namespace navvy::planner
