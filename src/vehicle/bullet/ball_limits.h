// SPDX-License-Identifier: Apache-2.0
// Limits of a ball joint: the cone and the twist of a hitch.
#pragma once

#include <array>
#include <optional>

#include "core/math.h"
#include "vehicle/bullet/multibody_rows.h"

namespace navvy::vehicle {

/// Stop of a ball joint: the remaining angle [rad], and the axis about which turning opens it, in
/// the parent's frame of the joint.
struct BallStop {
  double gap = 0;
  Vec3 axis = Vec3::Zero();
};

/// Returns the stops of a ball at rotation R (the child's joint frame in the parent's): cone, then
/// twist to either side. A stop is missing if it is free or undefined. The cone is the angle
/// between the x axes, the twist the rotation about them.
/// @param cone, twist [rad]; pi and more: free
std::array<std::optional<BallStop>, 3> ball_stops(const Mat3& R, double cone, double twist);

/// Stops of one ball joint: the x axis of the child (of the joint's frame) leans by at most `cone`
/// from its direction at the start, and the child turns by at most `twist` about it in either
/// direction. As for a hinge they act from the step in which they could be reached, with unlimited
/// impulse, and recover from an overrun slowly.
class BallLimits final : public MultibodyRows {
 public:
  /// Adds the rows of one joint.
  /// @param link Bullet's link of the joint
  /// @param R_CJ, R_PJ axes of the joint's frame in Bullet's frames of the child, and of the parent
  /// at the start
  /// @param cone, twist [rad]; pi and more: free
  BallLimits(btMultiBody* body, int link, const Mat3& R_CJ, const Mat3& R_PJ, double cone,
             double twist);

  // Bullet calls this in every step.
  void createConstraintRows(btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data,
                            const btContactSolverInfo& info) override;

 private:
  /// Adds a row that keeps `gap` [rad] open, which grows as the child turns about `axis`, in the
  /// child's frame.
  void keep_open(int row, double gap, const Vec3& axis, btMultiBodyConstraintArray& rows,
                 btMultiBodyJacobianData& data, const btContactSolverInfo& info);

  Mat3 R_CJ_, R_PJ_;
  double cone_, twist_;
};

}  // namespace navvy::vehicle
