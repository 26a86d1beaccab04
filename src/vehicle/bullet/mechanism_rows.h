// SPDX-License-Identifier: Apache-2.0
// Constraint rows of mechanisms: fixed ratios between two joints, joints that close loops, and
// springs of joints. None of them has state: everything follows from positions.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "scene/machine.h"
#include "vehicle/bullet/body.h"
#include "vehicle/bullet/multibody_rows.h"

namespace navvy::vehicle {

/// Constraint rows that keep fixed ratios between joints and close loops of links, with unlimited
/// impulse. What is violated, as the motion of a step leaves it, is restored slowly.
///
/// In most loops, some of the six directions that a joint holds are held by the other joints
/// already: in a plane four-bar, three of five. Rows along them would make the solver fight the
/// rounding of the file. In every step, directions along which a loop cannot move anyway are left
/// out, and all rows are combined so that an impulse along one does not move the machine along
/// another: the solver meets them in one iteration. Rows of motors and springs are combined with
/// them in the same way by project().
class MechanismRows final : public MultibodyRows {
 public:
  /// Allocates the rows of all gears and loops of `machine`, which has at least one. `machine` and
  /// `tree` must exist as long as this object.
  /// @throws InputError for a gear of joints without a position of one number, or of ratio zero
  MechanismRows(const scene::Machine& machine, TreeBody& tree);

  /// Computes the rows at the tree's positions for a step of `dt` [s]. Call it after the forces of
  /// the step, before the solver.
  void prepare(double dt);
  /// Changes the Jacobian of another row, with one entry per degree of freedom of the machine, so
  /// that its impulse does not move the machine along the rows of this object.
  ///
  /// The row then measures less than before by a velocity that these rows give the machine, which
  /// the function returns. Returns nothing if these rows leave no motion along the other row.
  std::optional<double> project(double* jacobian) const;

  /// Adds the rows to the solver. Bullet calls it in every step.
  void createConstraintRows(btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data,
                            const btContactSolverInfo& info) override;

 private:
  /// Rows: Jacobians with one entry per degree of freedom of the machine, and gaps. Angles of loops
  /// are multiplied by the size of their loop.
  struct Rows {
    Eigen::MatrixXd jacobian;
    Eigen::VectorXd gap;
  };
  /// Returns the size of a loop [m]: the distance of its farthest link from the closing joint.
  double size_of(const scene::LoopJoint& loop) const;
  /// Returns the rows of a gear.
  Rows gear_row(const scene::JointGear& gear) const;
  /// Returns the rows of all directions that the closing joint of a loop holds.
  Rows held_by(const scene::LoopJoint& loop, double size) const;
  /// Leaves out directions that a loop cannot move along.
  void reduce(Rows& rows, double size) const;

  /// Scene data of the machine.
  const scene::Machine& machine_;
  /// Tree of the machine.
  TreeBody& tree_;
  /// Size of each loop [m], in the order of the machine.
  std::vector<double> sizes_;
  /// Rows of this step, independent of each other and of unit inverse mass: Jacobians, the
  /// responses of the machine to unit impulses (one column each), and the velocities to reach.
  Eigen::MatrixXd jacobian_, response_;
  Eigen::VectorXd velocity_;
};

/// Constraint row of the spring of one revolute or prismatic joint.
class SpringRow final : public MultibodyRows {
 public:
  /// Allocates the row for a joint with a spring. `link` is Bullet's index of the joint's child.
  /// `mechanism` holds the machine's gears and loops, or is null.
  SpringRow(btMultiBody* body, int link, const scene::Joint& joint, const MechanismRows* mechanism);

  /// Adds the row to the solver. Bullet calls it in every step.
  void createConstraintRows(btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data,
                            const btContactSolverInfo& info) override;

 private:
  /// Stiffness [N m/rad|N/m], and position at which the spring is relaxed [rad|m].
  double stiffness_, rest_;
  /// Rows of the machine's gears and loops, or null.
  const MechanismRows* mechanism_;
};

/// Returns the rows of a machine's gears and loops, or null if it has none. `machine` and `tree`
/// must exist as long as the rows.
std::unique_ptr<MechanismRows> make_mechanism_rows(const scene::Machine& machine, TreeBody& tree);

/// Returns the rows of the springs of a machine, which may be coupled by `mechanism`, or null.
std::vector<std::unique_ptr<SpringRow>> make_springs(const scene::Machine& machine, TreeBody& tree,
                                                     const MechanismRows* mechanism);

}  // namespace navvy::vehicle
