// SPDX-License-Identifier: Apache-2.0
// Contact of a machine's shells with the level rock below all soil, as constraint rows in the
// solver that moves the machine.
#pragma once

#include <vector>

#include "core/archive.h"
#include "vehicle/bullet/body.h"
#include "vehicle/bullet/multibody_rows.h"

namespace navvy::vehicle {

/// Constraint rows that keep the corners of one shell (the steel plates of a tool) above the rock.
/// The corners slide on the rock with the friction of steel on rock.
///
/// The rows are solved together with joints, tyres and contacts. A cylinder that presses the tool
/// on rock therefore stalls, and the machine lifts. Each corner's friction is limited by the
/// corner's normal impulse in the last step. It is thus zero in the first step of a contact, and
/// too large for one step after an impact.
class RockContact final : public MultibodyRows {
 public:
  /// Allocates the rows of a shell that is mounted on the link with index `link`.
  /// @param corners corners of the shell in the link's frame [m]
  RockContact(TreeBody& tree, int link, std::vector<Vec3> corners);

  /// Sets the height of the rock's surface in the world frame [m].
  void set_height(double z) { height_ = z; }
  /// Reads the impulses from the solver. Call it after the solver, before the positions change.
  void settle();
  /// Returns the impulse of the rock on the shell in the last step, in the world frame [N s].
  const Vec3& impulse() const { return impulse_; }

  /// Saves, loads or hashes the normal impulse of each corner, which limits the friction of the
  /// next step, and the impulse on the shell.
  void visit(Archive& a);

  /// Adds the rows of all corners that could reach the rock in this step. Bullet calls it in every
  /// step.
  void createConstraintRows(btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data,
                            const btContactSolverInfo& info) override;

 private:
  /// Sets the Jacobian of the row with index `row` so that it measures the velocity of the link's
  /// point `p_W` [m] along the unit vector `along`.
  void aim(int row, const Vec3& p_W, const Vec3& along);

  /// Tree of the machine that carries the shell.
  TreeBody& tree_;
  /// Index of the link that carries the shell.
  int link_;
  /// Corners of the shell in the link's frame [m].
  std::vector<Vec3> corners_;
  /// Height of the rock's surface in the world frame [m].
  double height_ = -1e6;
  /// Normal impulse of each corner in the last step [N s].
  std::vector<double> normal_;
  /// Direction of each row of the current step, three rows per corner; zero for a row that was not
  /// added.
  std::vector<Vec3> along_;
  /// Impulse of the rock on the shell in the last step, in the world frame [N s].
  Vec3 impulse_ = Vec3::Zero();
};

}  // namespace navvy::vehicle
