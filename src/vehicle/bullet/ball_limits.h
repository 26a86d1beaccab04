// SPDX-License-Identifier: Apache-2.0
// Limits of a ball joint: the cone and the twist range of, for example, a hitch.
#pragma once

#include <array>
#include <optional>

#include "core/math.h"
#include "vehicle/bullet/multibody_rows.h"

namespace navvy::vehicle {

/// Stop of a ball joint at the joint's current rotation.
struct BallStop {
  /// Angle by which the joint can still turn before it reaches the stop [rad]; negative if it is
  /// beyond the stop.
  double gap = 0;
  /// Axis, in the joint's frame on the parent, about which positive rotation of the child moves
  /// away from the stop.
  Vec3 axis = Vec3::Zero();
};

/// Returns the three stops of a ball joint at the rotation `R` of the child's joint frame in the
/// parent's: the cone, the lower twist limit and the upper twist limit.
///
/// The cone angle is the angle between the x axes of both frames; the twist is the rotation about
/// them. A stop is empty if its angle is unlimited or cannot be determined at this rotation.
/// @param cone, twist limits of the two angles [rad]; pi or more means unlimited
std::array<std::optional<BallStop>, 3> ball_stops(const Mat3& R, double cone, double twist);

/// Constraint rows for the stops of one ball joint.
///
/// The x axis of the joint's frame on the child may deviate by at most `cone` from its initial
/// direction, and the child may turn by at most `twist` about it in either direction. The stops act
/// with unlimited impulse, from the step in which they could be reached. A joint beyond a stop
/// returns slowly.
class BallLimits final : public MultibodyRows {
 public:
  /// Allocates the rows for one ball joint.
  /// @param link Bullet's index of the joint's child link
  /// @param R_CJ axes of the joint's frame in Bullet's frame of the child
  /// @param R_PJ axes of the joint's frame in Bullet's frame of the parent at the initial position
  /// @param cone, twist limits [rad]; pi or more means unlimited
  BallLimits(btMultiBody* body, int link, const Mat3& R_CJ, const Mat3& R_PJ, double cone,
             double twist);

  /// Adds the rows of all stops that could be reached in this step. Bullet calls it in every step.
  void createConstraintRows(btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data,
                            const btContactSolverInfo& info) override;

 private:
  /// Adds the row with index `row` that stops the child before the angle `gap` [rad] becomes
  /// negative. The gap grows as the child turns about `axis`, which is given in the child's frame.
  void keep_open(int row, double gap, const Vec3& axis, btMultiBodyConstraintArray& rows,
                 btMultiBodyJacobianData& data, const btContactSolverInfo& info);

  /// Axes of the joint's frame in Bullet's frame of the child, and of the parent at the initial
  /// position.
  Mat3 R_CJ_, R_PJ_;
  /// Limits of cone angle and twist [rad].
  double cone_, twist_;
};

}  // namespace navvy::vehicle
