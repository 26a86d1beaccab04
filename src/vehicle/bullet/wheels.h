// SPDX-License-Identifier: Apache-2.0
// The wheels of a machine in the Bullet engine: where they are and what the ground does to their
// tyres.
#pragma once

#include <array>
#include <vector>

#include "terramechanics/track.h"
#include "terramechanics/track_body.h"
#include "terramechanics/tyre.h"
#include "vehicle/bullet/body.h"

namespace navvy::vehicle {

/// A wheel between two steps. Joints and links are indices of scene::Machine, -1: none.
struct MachineWheel {
  int spin_joint = -1, steer_joint = -1, wheel_link = -1, carrier_link = -1;
  double spin_inertia = 1;       // [kg m2]
  Vec3 axis_C = Vec3::UnitY();   // spin axis in the carrier
  Vec3 center_C = Vec3::Zero();  // in the carrier [m]

  // Memory and outcome of the tyre's law, then the brake's hold.
  terramechanics::TyreState tyre;
  terramechanics::TyreForce force;  // of the last step
  double held_spin = 0;             // angle at which the brake holds [rad]
  bool braked = false;
  // Of a crawler's sprocket: the belt on its rollers; no contacts of others.
  terramechanics::TrackState running_track;

  // Of bodies, which TyreBodies saves: their force in the last step [N], the grip's stretch on each
  // track [m].
  Vec3 body_W = Vec3::Zero();
  std::array<Vec2, 2> body_bristle{Vec2::Zero(), Vec2::Zero()};
  // Of bodies under a crawler's belt, likewise: how far shoes are sheared on them, and the middle
  // of what presses, in the carrier [m].
  terramechanics::TrackBodyShear body_shear;
  Vec3 body_p_C = Vec3::Zero();

  void visit(Archive& a);
};

/// Tyres push on the tree once a step, by terramechanics' law of the ground under them. What they
/// meet of bodies is TyreBodies'; collision shapes of other links touch the ground in the engine's
/// solver and are no wheels.
class MachineWheels {
 public:
  /// @throws InputError for a wheel whose joint is missing, is not revolute or hangs on the world.
  /// Machine and tree must outlive it.
  MachineWheels(const scene::Machine& machine, TreeBody& tree);

  /// In the order of machine.wheels.
  std::size_t size() const { return wheels_.size(); }
  MachineWheel& operator[](std::size_t i) { return wheels_[i]; }
  const MachineWheel& operator[](std::size_t i) const { return wheels_[i]; }
  std::vector<MachineWheel>& all() { return wheels_; }

  /// Adds the tyres' forces [N] to the tree for this step; returns their impulse [N s].
  Vec3 push(const terramechanics::GroundQuery& ground, double dt);

  /// Pose (not spinning) and motion of a wheel's centre.
  terramechanics::TyreMotion motion(const MachineWheel& wheel) const;
  /// The same of a crawler's belt.
  terramechanics::TrackMotion track_motion(const MachineWheel& wheel) const;
  const scene::Wheel& about(std::size_t i) const { return machine_.wheels[i]; }

  /// For outputs and ruts: where it is now, what acted on it in the last step.
  WheelState state(int wheel) const;
  /// Where its belt presses, with the loads of the last step; none of a wheel without one.
  std::vector<terramechanics::TrackPatch> track_patches(int wheel) const;

 private:
  /// Adds the forces on a crawler's belt, and its torque on the sprocket.
  void push_ground_track(std::size_t w, const terramechanics::GroundQuery& ground, double dt);

  // Tyre data stay in the machine; a wheel here knows its place in the tree.
  const scene::Machine& machine_;
  TreeBody& tree_;
  std::vector<MachineWheel> wheels_;
};

}  // namespace navvy::vehicle
