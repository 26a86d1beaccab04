// SPDX-License-Identifier: Apache-2.0
#include "control/activities/dig/clear_strip.h"

#include <algorithm>
#include <cmath>

#include "scene/polygon.h"

namespace navvy::control {
namespace {

// Distance behind a body at which the bucket goes down, so that it has turned to its digging angle
// when it meets the body, and the least one [m].
constexpr double kRun = 0.9, kLeastRun = 0.35;
// Distance in front of a body to which the edge is drawn [m]: it pushes the body until the bucket
// has turned, 1.3 m after it went down, and passes under it then.
constexpr double kPast = 1.3;
constexpr double kBelow = 0.03;     // edge below the lowest point of a body [m]
constexpr double kMostSunk = 0.4;   // of a body that lies in a hollow [m]
constexpr double kFromLimit = 0.1;  // of the arm's reach [m]
constexpr double kBetween = 0.1;    // bucket and a body behind it [m]
constexpr double kBack = 0.3;       // of the bucket, behind its edge when it goes down [m]

/// Returns the distances from the swing axis between which the tip can be over the body on the
/// ground as well as above the rim [m].
TipReach tip_over(const ArmKinematics& arm, const Pose& X_WS, const BodyView& body, double rim,
                  double ground) {
  TipReach out{kNearestDig, arm.longest() + 2};
  for (const double z : {ground, std::max(ground, rim) + kClear}) {
    const SwingPoint at = swing_point(X_WS, Vec3(body.centre.x(), body.centre.y(), z));
    const TipReach here = tip_reach(arm, at.height, at.pitch);
    out.least = std::max(out.least, here.least + kFromLimit);
    out.most = std::min(out.most, here.most - kFromLimit);
  }
  return out;
}

}  // namespace

void ClearStrip::visit(Archive& a) {
  a("near", near);
  a("far", far);
  a("floor", floor);
  a.require(floor.size() == 2, "floor", "needs two heights");
  a("rim", rim);
  a("behind", behind);
  a("before", before);
}

std::vector<BodyView> bodies_in(const std::vector<Vec2>& polygon,
                                const std::vector<BodyView>& bodies) {
  std::vector<BodyView> out;
  for (const BodyView& body : bodies)
    if (scene::contains(polygon, body.centre.head<2>())) out.push_back(body);
  return out;
}

double rim_over(const ArmKinematics& arm, const Pose& X_WS, const std::vector<BodyView>& bodies) {
  double rim = -1e9;
  for (const BodyView& body : bodies)
    if ((body.centre - X_WS.translation()).head<2>().norm() < arm.longest() + body.radius())
      rim = std::max(rim, body.top());
  return rim;
}

TipReach clear_reach(const ArmKinematics& arm, const Pose& X_WS, const BodyView& body, double rim,
                     const SurfaceView& surface) {
  const double ground = surface.height(body.centre.x(), body.centre.y());
  const TipReach tip = tip_over(arm, X_WS, body, rim, ground);
  const TipReach out{tip.least + body.radius(), tip.most - body.radius() - kLeastRun};
  return out.least <= out.most ? out : TipReach{};
}

std::optional<ClearStrip> clear_strip(const ArmKinematics& arm, const Pose& X_WS,
                                      const BodyView& body, const std::vector<BodyView>& bodies,
                                      double depth, const SurfaceView& surface) {
  ClearStrip out;
  out.rim = rim_over(arm, X_WS, bodies);
  const Vec2 axis = X_WS.translation().head<2>(), middle = body.centre.head<2>();
  const double reach = (middle - axis).norm(), radius = body.radius();
  const TipReach possible = clear_reach(arm, X_WS, body, out.rim, surface);
  const bool turns = arm.swings_to(swing_point(X_WS, body.centre).swing);
  if (!turns || reach < possible.least || reach > possible.most) return std::nullopt;
  const Vec2 along = (middle - axis) / reach, across(-along.y(), along.x());
  const double near = std::max(reach - radius - kPast, possible.least - radius);
  const double whole = std::min(reach + radius + kRun, possible.most + radius + kLeastRun);
  double far = whole;
  for (const BodyView& other : bodies) {
    const Vec2 off = other.centre.head<2>() - middle;
    const double side = std::abs(off.dot(across)), at = reach + off.dot(along);
    if (other.name == body.name || side > 0.5 * arm.bucket().width + other.radius() ||
        at < near - other.radius() || at > whole + other.radius() + kBack)
      continue;
    if (at < reach) {
      ++out.before;
      continue;
    }
    const double back = arm.beyond_tip(with_cut(arm, kPlunge), 2 * other.radius());
    const double between = at - other.radius() - back - kBetween;
    if (between < reach + radius + kLeastRun) ++out.behind;
    far = std::min(far, std::max(between, reach + radius + kLeastRun));
  }
  out.near = axis + near * along;
  out.far = axis + far * along;
  out.floor = {surface.height(out.near.x(), out.near.y()) - depth,
               surface.height(out.far.x(), out.far.y()) - depth};
  const double at_body =
      out.floor[0] + (out.floor[1] - out.floor[0]) * (reach - near) / (far - near);
  const double sunk = std::clamp(at_body - body.bottom() + kBelow, 0.0, kMostSunk);
  for (double& z : out.floor) z -= sunk;
  return out;
}

}  // namespace navvy::control
