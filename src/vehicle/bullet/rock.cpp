// SPDX-License-Identifier: Apache-2.0
#include "vehicle/bullet/rock.h"

#include <algorithm>
#include <cmath>

namespace navvy::vehicle {
namespace {

constexpr double kFriction = 0.5;  // steel on rock (U: 0.4 to 0.6)
constexpr double kPressOut = 0.1;  // share of an overlap that is resolved in a step,
constexpr double kSlowly = 0.1;    // at most [m/s]
constexpr int kRows = 3;           // per corner: up, along its sliding, across it

}  // namespace

RockContact::RockContact(TreeBody& tree, int link, std::vector<Vec3> corners)
    : MultibodyRows(&tree.multibody(), tree.bullet_of_link(link),
                    kRows * static_cast<int>(corners.size())),
      tree_(tree),
      link_(link),
      corners_(std::move(corners)),
      normal_(corners_.size(), 0.0),
      along_(kRows * corners_.size(), Vec3::Zero()) {
  finalizeMultiDof();
}

void RockContact::aim(int row, const Vec3& p_W, const Vec3& along) {
  along_[static_cast<std::size_t>(row)] = along;
  // The work of a unit impulse at the point is the Jacobian of its velocity along it.
  tree_.virtual_work(link_, along, Vec3::Zero(), p_W, jacobianA(row));
}

// One normal and two friction rows per corner that may touch.
void RockContact::createConstraintRows(btMultiBodyConstraintArray& rows,
                                       btMultiBodyJacobianData& data,
                                       const btContactSolverInfo& info) {
  const double dt = info.m_timeStep;
  const LinkState state = tree_.link(link_);
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    const int row = kRows * static_cast<int>(i);
    // Clear the row: without it, the last step's impulse would be read.
    for (int r = 0; r < kRows; ++r) internalSetAppliedImpulse(row + r, 0);
    for (int r = 0; r < kRows; ++r) along_[static_cast<std::size_t>(row + r)].setZero();
    const Vec3 p = state.X_WL * corners_[i];
    const Vec3 v = state.v_WL + state.w_WL.cross(p - state.X_WL.translation());
    const double gap = p.z() - height_;
    // Only corners that could reach the rock in this step. Joints may still move one further than
    // its velocity.
    if (gap > 2 * dt * v.norm() + 0.01) {
      normal_[i] = 0;
      continue;
    }
    // It may approach by the gap and no more. An overlap is resolved slowly, or it would act as a
    // spring.
    const double up = gap > 0 ? -gap / dt : std::min(-kPressOut * gap / dt, kSlowly);
    aim(row, p, Vec3::UnitZ());
    add_row(row, up, 0, 1e12, rows, data, info);
    // No normal impulse yet, so no friction: the error of one step is negligible.
    if (!(normal_[i] > 0)) continue;
    // Along the sliding and across it, so that the box of limits is close to Coulomb's circle.
    const Vec2 slide = v.head<2>();
    const Vec3 ahead =
        slide.norm() > 1e-6 ? Vec3(slide.x(), slide.y(), 0).normalized() : Vec3::UnitX();
    const double bound = kFriction * normal_[i];
    aim(row + 1, p, ahead);
    aim(row + 2, p, Vec3::UnitZ().cross(ahead));
    for (const int r : {row + 1, row + 2}) add_row(r, 0, -bound, bound, rows, data, info);
  }
}

// Sums the corners' impulses and stores their normal parts for the next step.
void RockContact::settle() {
  // In W, by the directions of the rows.
  impulse_.setZero();
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    const int row = kRows * static_cast<int>(i);
    for (int r = 0; r < kRows; ++r)
      impulse_ += getAppliedImpulse(row + r) * along_[static_cast<std::size_t>(row + r)];
    normal_[i] = getAppliedImpulse(row);
  }
}

void RockContact::visit(Archive& a) {
  // The corners' normal impulses limit the next step's friction. Another number of corners is
  // another shell.
  a.fixed("normal", normal_);
  a("impulse", impulse_);
}

}  // namespace navvy::vehicle
