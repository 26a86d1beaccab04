// SPDX-License-Identifier: Apache-2.0
// Wheels of a machine in the Bullet engine: their motion and the forces of the ground on their
// tyres.
#pragma once

#include <array>
#include <vector>

#include "terramechanics/track.h"
#include "terramechanics/track_body.h"
#include "terramechanics/tyre.h"
#include "vehicle/bullet/body.h"

namespace navvy::vehicle {

/// Wheel between two steps. Joints and links are indices of scene::Machine, -1: none.
struct MachineWheel {
  int spin_joint = -1, steer_joint = -1, wheel_link = -1, carrier_link = -1;
  double spin_inertia = 1;  // [kg m2]
  // Spin axis in the carrier.
  Vec3 axis_C = Vec3::UnitY();
  // Centre in the carrier [m].
  Vec3 center_C = Vec3::Zero();

  // State and result of the tyre's law, then the brake's hold.
  terramechanics::TyreState tyre;
  terramechanics::TyreForce force;  // of the last step
  // Angle at which the brake holds [rad].
  double held_spin = 0;
  bool braked = false;
  // State of a crawler's track under its sprocket; no contacts for other wheels.
  terramechanics::TrackState running_track;

  // Force of bodies in the last step [N] and the bristles of each contact strip on them [m].
  // TyreBodies saves both.
  Vec3 body_W = Vec3::Zero();
  std::array<Vec2, 2> body_bristle{Vec2::Zero(), Vec2::Zero()};
  // Shear of shoes on bodies under a crawler's track, and the centre of these forces in the carrier
  // [m]. TyreBodies saves both.
  terramechanics::TrackBodyShear body_shear;
  Vec3 body_p_C = Vec3::Zero();

  /// Visits tyre, track and brake; TyreBodies visits the rest.
  void visit(Archive& a);
};

/// Applies the ground's forces on tyres and tracks to the tree once per step, by terramechanics'
/// laws. TyreBodies handles bodies; collision shapes of other links touch the ground in the
/// engine's solver and are no wheels.
class MachineWheels {
 public:
  /// Resolves the joints. Machine and tree must outlive this object.
  /// @throws InputError for a wheel whose joint is missing, is not revolute or is attached to the
  /// world.
  MachineWheels(const scene::Machine& machine, TreeBody& tree);

  /// Returns the number of wheels, in the order of machine.wheels.
  std::size_t size() const { return wheels_.size(); }
  /// Returns a wheel. The index is not checked.
  MachineWheel& operator[](std::size_t i) { return wheels_[i]; }
  const MachineWheel& operator[](std::size_t i) const { return wheels_[i]; }
  /// Returns all wheels.
  std::vector<MachineWheel>& all() { return wheels_; }

  /// Adds the tyres' forces [N] to the tree for this step and returns their impulse [N s].
  Vec3 push(const terramechanics::GroundQuery& ground, double dt);

  /// Returns pose (not spinning) and motion of a wheel's centre.
  terramechanics::TyreMotion motion(const MachineWheel& wheel) const;
  /// Returns the same for a crawler's track.
  terramechanics::TrackMotion track_motion(const MachineWheel& wheel) const;
  /// Returns the data of a wheel.
  const scene::Wheel& about(std::size_t i) const { return machine_.wheels[i]; }

  /// Returns pose and forces after the last step, for outputs and ruts.
  WheelState state(int wheel) const;
  /// Returns where the wheel's track presses, with the loads of the last step; empty without a
  /// track.
  std::vector<terramechanics::TrackPatch> track_patches(int wheel) const;

 private:
  /// Adds the forces on a crawler's track, and its torque on the sprocket.
  void push_ground_track(std::size_t w, const terramechanics::GroundQuery& ground, double dt);

  // The machine owns the tyre data; this class owns the state and the place in the tree.
  const scene::Machine& machine_;
  TreeBody& tree_;
  std::vector<MachineWheel> wheels_;
};

}  // namespace navvy::vehicle
