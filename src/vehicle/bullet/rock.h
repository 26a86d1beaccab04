// SPDX-License-Identifier: Apache-2.0
// Level rock below all soil, against the shells of a machine: constraint rows in the solver that
// moves the machine.
#pragma once

#include <vector>

#include "core/archive.h"
#include "vehicle/bullet/body.h"
#include "vehicle/bullet/multibody_rows.h"

namespace navvy::vehicle {

/// Keeps the corners of one shell out of the rock; they slide on it with the friction of steel on
/// rock.
///
/// Solved together with joints, tyres and contacts, so that a cylinder that presses on rock stalls
/// and the machine lifts. Each corner's friction is bounded by its normal impulse of the step
/// before: none in the first step of a touch, and after a blow too much for one.
class RockContact final : public MultibodyRows {
 public:
  /// @param corners in the link's frame [m]
  RockContact(TreeBody& tree, int link, std::vector<Vec3> corners);

  /// Of the rock's surface in W [m].
  void set_height(double z) { height_ = z; }
  /// Reads the solver's impulses, before positions change.
  void settle();
  /// On the shell in the last step [N s].
  const Vec3& impulse() const { return impulse_; }

  /// The corners' normal impulses and the sum: state, as the next step's friction reads them.
  void visit(Archive& a);

  void createConstraintRows(btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data,
                            const btContactSolverInfo& info) override;

 private:
  /// Row of the velocity of the point p_W of the link along a direction.
  void aim(int row, const Vec3& p_W, const Vec3& along);

  TreeBody& tree_;
  int link_;
  std::vector<Vec3> corners_;
  double height_ = -1e6;
  std::vector<double> normal_;  // impulse of each corner in the last step [N s]
  std::vector<Vec3> along_;     // directions of the present rows, three a corner
  Vec3 impulse_ = Vec3::Zero();
};

}  // namespace navvy::vehicle
