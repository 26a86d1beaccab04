// SPDX-License-Identifier: Apache-2.0
#include "earthwork/spoil_place.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "control/dig_pose.h"

namespace navvy::earthwork {
namespace {

constexpr double kSpacing = 0.5;     // of points along a windrow [m]
constexpr double kHeapRadius = 0.6;  // around a point, whose highest ground counts [m]

/// Returns the highest ground around a point [m].
double heap_height(const control::SurfaceView& surface, const Vec2& p) {
  double highest = surface.height(p.x(), p.y());
  for (int i = 0; i < 8; ++i) {
    const double a = i * kPi / 4;
    highest = std::max(highest, surface.height(p.x() + kHeapRadius * std::cos(a),
                                               p.y() + kHeapRadius * std::sin(a)));
  }
  return highest;
}

}  // namespace

std::vector<Vec2> spoil_points(const control::PitJob& job) {
  const Vec2 along = job.dump_to - job.dump_from;
  const int pieces = static_cast<int>(std::ceil(along.norm() / kSpacing - 1e-9));
  std::vector<Vec2> out;
  for (int i = 0; i <= pieces; ++i)
    out.push_back(pieces == 0 ? job.dump_from
                              : Vec2(job.dump_from + along * static_cast<double>(i) / pieces));
  return out;
}

std::optional<Vec2> spoil_place(const control::PitJob& job, const control::ArmKinematics& arm,
                                const Pose& X_WS, const control::SurfaceView& surface) {
  std::optional<Vec2> best;
  double lowest = std::numeric_limits<double>::infinity();
  for (const Vec2& p : spoil_points(job)) {
    const double height = heap_height(surface, p);
    control::ArmAngles q;
    double possible = 0;
    if (height >= lowest || !control::dump_pose(arm, X_WS, p, height, job.dump_height, q, possible))
      continue;
    lowest = height;
    best = p;
  }
  return best;
}

}  // namespace navvy::earthwork
