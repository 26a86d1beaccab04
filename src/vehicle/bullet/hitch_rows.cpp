// SPDX-License-Identifier: Apache-2.0
#include "vehicle/bullet/hitch_rows.h"

#include <algorithm>
#include <string>

#include "core/error.h"
#include "vehicle/bullet/ball_limits.h"

namespace navvy::vehicle {
namespace {

constexpr double kClosing = 0.2;  // share of the distance that is closed in a step,
constexpr double kSlowly = 0.5;   // at most [m/s]
constexpr int kBall = 3;          // first row of the ball's stops

}  // namespace

HitchRows::HitchRows(const scene::Hitch& hitch, TreeBody& parent, TreeBody& child)
    : MultibodyRows(&parent.multibody(), parent.bullet_of_link(hitch.parent_link),
                    &child.multibody(), child.bullet_of_link(hitch.child_link), kBall + 3),
      hitch_(hitch),
      parent_(parent),
      child_(child),
      closed_(hitch.closed) {
  finalizeMultiDof();
}

void HitchRows::set(bool closed) {
  if (closed && !closed_) {
    const double apart = (eye() - hook()).norm();
    if (apart > kHitchReach)
      throw InputError(Fault{Fault::Severity::kError, "", 0, "hitch '" + hitch_.name + "'",
                             std::to_string(apart) + " m",
                             "the hitch closes when the eye is within 0.1 m of the hook",
                             "drive the hook to the eye first"});
  }
  closed_ = closed;
  if (!closed_) force_.setZero();
}

HitchState HitchRows::state() const { return {closed_, (eye() - hook()).norm(), force_}; }

void HitchRows::aim(int row, const Vec3& J_W, const Vec3& L_W, const Vec3& on_parent,
                    const Vec3& on_child) {
  parent_.virtual_work(hitch_.parent_link, J_W, L_W, on_parent, jacobianA(row));
  child_.virtual_work(hitch_.child_link, -J_W, -L_W, on_child, jacobianB(row));
}

// Three rows hold the eye in the hook, further rows are the ball's stops.
void HitchRows::createConstraintRows(btMultiBodyConstraintArray& rows,
                                     btMultiBodyJacobianData& data,
                                     const btContactSolverInfo& info) {
  for (int row = 0; row < kBall + 3; ++row) internalSetAppliedImpulse(row, 0);
  if (!closed_) return;
  const Vec3 at = hook(), from = eye(), apart = from - at;
  const Vec3 closing =
      apart * std::min(kClosing / info.m_timeStep, kSlowly / std::max(apart.norm(), 1e-12));
  for (int i = 0; i < 3; ++i) {
    aim(i, Vec3::Unit(i), Vec3::Zero(), at, from);
    add_row(i, closing[i], -1e12, 1e12, rows, data, info);
  }
  const LinkState parent = parent_.link(hitch_.parent_link), child = child_.link(hitch_.child_link);
  const auto stops =
      ball_stops(parent.X_WL.linear().transpose() * child.X_WL.linear(), hitch_.cone, hitch_.twist);
  for (int s = 0; s < 3; ++s) {
    const auto& stop = stops[static_cast<std::size_t>(s)];
    if (!stop) continue;
    // The stop opens as the child turns about its axis, so the parent turns the other way.
    const Vec3 axis = parent.X_WL.linear() * stop->axis;
    aim(kBall + s, Vec3::Zero(), -axis, at, from);
    add_stop(kBall + s, stop->gap, axis.dot(child.w_WL - parent.w_WL), rows, data, info);
  }
}

void HitchRows::end_step(double dt) {
  for (int i = 0; i < 3; ++i) force_[i] = getAppliedImpulse(i) / dt;
}

void HitchRows::visit(Archive& a) {
  a("closed", closed_);
  a("force", force_);
}

}  // namespace navvy::vehicle
