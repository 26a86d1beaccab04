// SPDX-License-Identifier: Apache-2.0
// Level rock below all soil, against the shells of a machine: constraint rows in the solver that
// moves the machine.
#pragma once

#include <vector>

#include "core/archive.h"
#include "vehicle/bullet/body.h"
#include "vehicle/bullet/multibody_rows.h"

namespace navvy::vehicle {

/// Keeps the corners of one shell out of the rock. They slide on it with the friction of steel on
/// rock.
///
/// The rows are solved together with joints, tyres and contacts, so that a cylinder that presses on
/// rock stalls and the machine lifts. Each corner's friction is limited by its normal impulse of
/// the last step: zero in the first step of a contact, and too large for one step after an impact.
class RockContact final : public MultibodyRows {
 public:
  /// Adds the rows of a shell.
  /// @param corners in the link's frame [m]
  RockContact(TreeBody& tree, int link, std::vector<Vec3> corners);

  /// Sets the height of the rock's surface in W [m].
  void set_height(double z) { height_ = z; }
  /// Reads the solver's impulses, before positions change.
  void settle();
  /// Returns the impulse on the shell in the last step [N s].
  const Vec3& impulse() const { return impulse_; }

  /// Visits the corners' normal impulses, which the next step's friction reads, and their sum.
  void visit(Archive& a);

  void createConstraintRows(btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data,
                            const btContactSolverInfo& info) override;

 private:
  /// Sets a row to the velocity of the link's point p_W along a direction.
  void aim(int row, const Vec3& p_W, const Vec3& along);

  TreeBody& tree_;
  int link_;
  std::vector<Vec3> corners_;
  double height_ = -1e6;
  std::vector<double> normal_;  // impulse of each corner in the last step [N s]
  std::vector<Vec3> along_;     // directions of the present rows, three per corner
  Vec3 impulse_ = Vec3::Zero();
};

}  // namespace navvy::vehicle
