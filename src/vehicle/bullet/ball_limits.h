// SPDX-License-Identifier: Apache-2.0
// How far a ball joint turns: the cone and the twist of a hitch.
#pragma once

#include <array>
#include <optional>

#include "core/math.h"
#include "vehicle/bullet/multibody_rows.h"

namespace navvy::vehicle {

/// A stop of a ball joint: what is left to it [rad], and about which axis turning opens it, in the
/// parent's frame of the joint.
struct BallStop {
  double gap = 0;
  Vec3 axis = Vec3::Zero();
};

/// Of a ball that stands at R (the child's frame of the joint in the parent's): cone, then twist to
/// either side; none where it is free, or undefined. The cone is the lean of the x axes, twist the
/// turn about them.
/// @param cone, twist [rad]; pi and more: free
std::array<std::optional<BallStop>, 3> ball_stops(const Mat3& R, double cone, double twist);

/// Stops of one ball joint: its child's x axis (of the joint's frame) leans at most by `cone` from
/// where it points at the start, and the child turns at most by `twist` about it either way. Like
/// those of a hinge they act from the step in which they could be reached, at any cost, and leave
/// an overrun slowly.
class BallLimits final : public MultibodyRows {
 public:
  /// @param link Bullet's link of the joint
  /// @param R_CJ, R_PJ axes of the joint's frame in Bullet's frames of the child, and of the parent
  /// at the start
  /// @param cone, twist [rad]; pi and more: free
  BallLimits(btMultiBody* body, int link, const Mat3& R_CJ, const Mat3& R_PJ, double cone,
             double twist);

  // Called by Bullet in every step.
  void createConstraintRows(btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data,
                            const btContactSolverInfo& info) override;

 private:
  /// A row that keeps `gap` [rad] open, which grows as the child turns about `axis`, in the child's
  /// frame.
  void keep_open(int row, double gap, const Vec3& axis, btMultiBodyConstraintArray& rows,
                 btMultiBodyJacobianData& data, const btContactSolverInfo& info);

  Mat3 R_CJ_, R_PJ_;
  double cone_, twist_;
};

}  // namespace navvy::vehicle
