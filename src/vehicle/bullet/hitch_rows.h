// SPDX-License-Identifier: Apache-2.0
// Hitch between two machines: a hook on the parent and an eye on the child, coupled and uncoupled
// by command.
#pragma once

#include "core/archive.h"
#include "scene/hitch.h"
#include "vehicle/bullet/body.h"
#include "vehicle/bullet/multibody_rows.h"
#include "vehicle/machine_state.h"

namespace navvy::vehicle {

/// Constraint rows of a hitch. While the hitch is closed, they hold the child's eye in the parent's
/// hook with unlimited impulse and limit the rotation between both to a cone and a twist range. An
/// initial distance between hook and eye is closed slowly.
class HitchRows final : public MultibodyRows {
 public:
  /// Allocates the rows between the trees of the parent and the child machine. Both trees must
  /// exist as long as this object.
  HitchRows(const scene::Hitch& hitch, TreeBody& parent, TreeBody& child);

  /// Closes or opens the hitch.
  /// @throws InputError if an open hitch is to be closed while the eye is out of the hook's reach.
  void set(bool closed);
  /// Returns true if the hitch is closed.
  bool closed() const { return closed_; }
  /// Returns the state of the hitch after the last step.
  HitchState state() const;

  /// Adds the rows of a closed hitch to the solver. Bullet calls it in every step.
  void createConstraintRows(btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data,
                            const btContactSolverInfo& info) override;
  /// Computes the force of the hitch from the solver's impulses of a step of `dt` [s]. Call it
  /// after the solver.
  void end_step(double dt);

  /// Saves, loads or hashes whether the hitch is closed, and its force.
  void visit(Archive& a);

 private:
  /// Returns the position of the hook in the world frame [m].
  Vec3 hook() const { return parent_.link(hitch_.parent_link).X_WL * hitch_.hook; }
  /// Returns the position of the eye in the world frame [m].
  Vec3 eye() const { return child_.link(hitch_.child_link).X_WL * hitch_.eye; }
  /// Sets the Jacobians of the row with index `row`, so that it measures the velocity of the parent
  /// minus that of the child: the translation along `J_W` and the rotation about `L_W`, at the
  /// point `on_parent` of the parent and `on_child` of the child.
  void aim(int row, const Vec3& J_W, const Vec3& L_W, const Vec3& on_parent, const Vec3& on_child);

  /// Properties of the hitch as given in the scene.
  scene::Hitch hitch_;
  /// Tree of the machine with the hook.
  TreeBody& parent_;
  /// Tree of the machine with the eye.
  TreeBody& child_;
  /// True while the hitch is closed.
  bool closed_ = true;
  /// Force of the child on the parent in the last step, in the world frame [N].
  Vec3 force_ = Vec3::Zero();
};

}  // namespace navvy::vehicle
