// SPDX-License-Identifier: Apache-2.0
// A hitch between two machines: hook and eye, which can be let go and taken up again.
#pragma once

#include "core/archive.h"
#include "scene/hitch.h"
#include "vehicle/bullet/body.h"
#include "vehicle/bullet/multibody_rows.h"
#include "vehicle/machine_state.h"

namespace navvy::vehicle {

/// While it is closed, the eye on the child stays in the hook on the parent at any cost, and the
/// ball keeps to its cone and twist. What parts them (a start, a hook that takes an eye) is closed
/// slowly.
class HitchRows final : public MultibodyRows {
 public:
  /// Both trees must outlive it.
  HitchRows(const scene::Hitch& hitch, TreeBody& parent, TreeBody& child);

  /// @throws InputError for an eye that is out of the hook's reach.
  void set(bool closed);
  bool closed() const { return closed_; }
  HitchState state() const;

  // Called by Bullet in every step.
  void createConstraintRows(btMultiBodyConstraintArray& rows, btMultiBodyJacobianData& data,
                            const btContactSolverInfo& info) override;
  /// After the solver: takes the force out of the impulses of a step of dt [s].
  void end_step(double dt);

  void visit(Archive& a);

 private:
  Vec3 hook() const { return parent_.link(hitch_.parent_link).X_WL * hitch_.hook; }
  Vec3 eye() const { return child_.link(hitch_.child_link).X_WL * hitch_.eye; }
  /// The Jacobians of a row: parent minus child, moved along `J_W` and turned about `L_W` at their
  /// points.
  void aim(int row, const Vec3& J_W, const Vec3& L_W, const Vec3& on_parent, const Vec3& on_child);

  scene::Hitch hitch_;
  TreeBody& parent_;
  TreeBody& child_;
  bool closed_ = true;
  Vec3 force_ = Vec3::Zero();  // of the child on the parent in the last step [N]
};

}  // namespace navvy::vehicle
