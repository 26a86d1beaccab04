// SPDX-License-Identifier: Apache-2.0
#include "earthwork/spoil_place.h"

#include <cmath>
#include <limits>

#include "control/dig_pose.h"

namespace navvy::earthwork {
namespace {

constexpr double kSpacing = 0.5;  // of points along a windrow [m]
// Where it has grown too high, its sides are built out by up to this, towards the machine and away
// from it [m].
constexpr double kMostOff = 1.5;

}  // namespace

bool can_dump(const control::PitJob& job, const control::ArmKinematics& arm, const Pose& X_WS,
              const Vec2& p, double height) {
  control::ArmAngles q;
  double possible = 0;
  return control::dump_pose(arm, X_WS, p, height, job.dump_height, q, possible);
}

std::vector<Vec2> spoil_points(const control::PitJob& job) {
  std::vector<Vec2> out;
  const auto add = [&](const Vec2& from, const Vec2& to) {
    const Vec2 along = to - from;
    const int pieces = static_cast<int>(std::ceil(along.norm() / kSpacing - 1e-9));
    for (int i = 0; i <= pieces; ++i)
      out.push_back(pieces == 0 ? from : Vec2(from + along * static_cast<double>(i) / pieces));
  };
  add(job.dump_from, job.dump_to);
  if (job.second_windrow) add((*job.second_windrow)[0], (*job.second_windrow)[1]);
  return out;
}

std::vector<Vec2> reachable_spoil(const control::PitJob& job, const control::ArmKinematics& arm,
                                  const Pose& X_WS, const control::SurfaceView& surface) {
  std::vector<Vec2> out;
  for (const Vec2& p : spoil_points(job))
    if (can_dump(job, arm, X_WS, p, control::heap_height(surface, p))) out.push_back(p);
  return out;
}

std::optional<Vec2> spoil_place(const control::PitJob& job, const control::ArmKinematics& arm,
                                const Pose& X_WS, const control::SurfaceView& surface,
                                const PitShape& pit) {
  const Vec2 centre = X_WS.translation().head<2>();
  const std::vector<Vec2> line = spoil_points(job);
  std::optional<Vec2> best;
  double lowest = std::numeric_limits<double>::infinity();
  const auto offer = [&](const Vec2& p) {
    const double height = control::heap_height(surface, p);
    if (height >= lowest || !can_dump(job, arm, X_WS, p, height)) return;
    lowest = height;
    best = p;
  };
  for (const Vec2& p : line) offer(p);
  for (double off = kSpacing; off <= kMostOff && !best; off += kSpacing)
    for (const Vec2& p : line)
      for (const double side : {-off, off})
        if (const Vec2 beside = p + side * (p - centre).normalized();
            !pit.is_near(beside, kSpoilClear))
          offer(beside);
  return best;
}

}  // namespace navvy::earthwork
