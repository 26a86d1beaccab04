// SPDX-License-Identifier: Apache-2.0
// Hitch between two machines: hook and eye, which open and close.
#pragma once

#include "core/archive.h"
#include "scene/hitch.h"
#include "vehicle/bullet/body.h"
#include "vehicle/bullet/multibody_rows.h"
#include "vehicle/machine_state.h"

namespace navvy::vehicle {

/// Keeps the eye on the child in the hook on the parent with unlimited impulse while it is closed,
/// and limits the ball to its cone and twist. Closes an initial distance slowly.
class HitchRows final : public MultibodyRows {
 public:
  /// Adds the rows. Both trees must outlive this object.
  HitchRows(const scene::Hitch& hitch, TreeBody& parent, TreeBody& child);

  /// Closes or opens the hitch. @throws InputError for an eye that is out of the hook's reach.
  void set(bool closed);
  /// Returns whether the hitch is closed.
  bool closed() const { return closed_; }
  /// Returns the state after the last step.
  HitchState state() const;

  // Bullet calls this in every step.
  void createConstraintRows(btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data,
                            const btContactSolverInfo& info) override;
  /// Converts the impulses of a step of dt [s] to the force. Call it after the solver.
  void end_step(double dt);

  /// Visits whether it is closed, and the force.
  void visit(Archive& a);

 private:
  /// Returns the position of the hook in W [m].
  Vec3 hook() const { return parent_.link(hitch_.parent_link).X_WL * hitch_.hook; }
  /// Returns the position of the eye in W [m].
  Vec3 eye() const { return child_.link(hitch_.child_link).X_WL * hitch_.eye; }
  /// Sets the Jacobians of a row: parent minus child, translated along `J_W` and rotated about
  /// `L_W` at their points.
  void aim(int row, const Vec3& J_W, const Vec3& L_W, const Vec3& on_parent, const Vec3& on_child);

  scene::Hitch hitch_;
  TreeBody& parent_;
  TreeBody& child_;
  bool closed_ = true;
  Vec3 force_ = Vec3::Zero();  // of the child on the parent in the last step [N]
};

}  // namespace navvy::vehicle
