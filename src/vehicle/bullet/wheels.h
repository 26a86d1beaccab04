// SPDX-License-Identifier: Apache-2.0
// Wheels of a machine in the Bullet engine: their motion, and the forces of the ground on their
// tyres and tracks.
#pragma once

#include <array>
#include <vector>

#include "terramechanics/track.h"
#include "terramechanics/track_body.h"
#include "terramechanics/tyre.h"
#include "vehicle/bullet/body.h"

namespace navvy::vehicle {

/// Constant data of one wheel, and its state between two steps.
struct MachineWheel {
  /// Indices in scene::Machine: joint on which the wheel spins, joint that steers it (-1 if it is
  /// not steered), link of the wheel, and carrier link on which it spins.
  int spin_joint = -1, steer_joint = -1, wheel_link = -1, carrier_link = -1;
  /// Inertia of the wheel about its axis [kg m2].
  double spin_inertia = 1;
  /// Unit spin axis of the wheel in the frame of its carrier link.
  Vec3 axis_C = Vec3::UnitY();
  /// Centre of the wheel in the frame of its carrier link [m].
  Vec3 center_C = Vec3::Zero();

  /// State of the tyre on the ground.
  terramechanics::TyreState tyre;
  /// Force of the ground on the tyre or track in the last step.
  terramechanics::TyreForce force;
  /// Position of the spin joint at which the brake holds the wheel [rad], valid while `braked`.
  double held_spin = 0;
  /// True while the drive's brake holds the wheel.
  bool braked = false;
  /// State of the crawler's track that the wheel drives as its sprocket; without contacts for other
  /// wheels.
  terramechanics::TrackState running_track;

  /// Force of rigid bodies on the tyre or track in the last step, in the world frame [N].
  /// TyreBodies saves it.
  Vec3 body_W = Vec3::Zero();
  /// Deflection (forward, left) of the bristles of each contact strip on rigid bodies [m].
  /// TyreBodies saves it.
  std::array<Vec2, 2> body_bristle{Vec2::Zero(), Vec2::Zero()};
  /// Shear displacement of a crawler's shoes on rigid bodies; empty for a wheel without a track.
  /// TyreBodies saves it.
  terramechanics::TrackBodyShear body_shear;
  /// Mean point of application of `body_W` on a track, in the frame of the track's carrier link
  /// [m]. TyreBodies saves it.
  Vec3 body_p_C = Vec3::Zero();

  /// Saves, loads or hashes the state of tyre, track and brake. TyreBodies::visit() does so for the
  /// state of contacts with bodies.
  void visit(Archive& a);
};

/// All wheels of a machine. Once per step, it applies the forces of the ground on tyres and tracks
/// to the machine's tree, by the laws of the terramechanics module.
///
/// TyreBodies handles contacts of wheels with rigid bodies. Collision shapes of links touch the
/// ground in the engine's solver and do not count as wheels.
class MachineWheels {
 public:
  /// Resolves the joints of all wheels. `machine` and `tree` must exist as long as this object.
  /// @throws InputError for a wheel whose joint is missing, is not revolute or is attached to the
  /// world.
  MachineWheels(const scene::Machine& machine, TreeBody& tree);

  /// Returns the number of wheels.
  std::size_t size() const { return wheels_.size(); }
  /// Returns the wheel with index `i` in machine.wheels. The index is not checked.
  MachineWheel& operator[](std::size_t i) { return wheels_[i]; }
  /// Returns the wheel with index `i` in machine.wheels. The index is not checked.
  const MachineWheel& operator[](std::size_t i) const { return wheels_[i]; }
  /// Returns all wheels in the order of machine.wheels.
  std::vector<MachineWheel>& all() { return wheels_; }

  /// Computes the forces of `ground` on all tyres and tracks for a step of `dt` [s], adds them to
  /// the tree, and returns their total impulse in the world frame [N s].
  Vec3 push(const terramechanics::GroundQuery& ground, double dt);

  /// Returns the motion of a wheel at its centre, in a frame that does not spin with the wheel.
  terramechanics::TyreMotion motion(const MachineWheel& wheel) const;
  /// Returns the motion of a crawler's track, whose sprocket is `wheel`.
  terramechanics::TrackMotion track_motion(const MachineWheel& wheel) const;
  /// Returns the properties of a wheel as given in the scene.
  const scene::Wheel& about(std::size_t i) const { return machine_.wheels[i]; }

  /// Returns the state of the wheel with index `wheel` after the last step: its current motion and
  /// the forces of the last step.
  WheelState state(int wheel) const;
  /// Returns the rectangles on which the track of a wheel presses, with the loads of the last step;
  /// empty for a wheel without a track.
  std::vector<terramechanics::TrackPatch> track_patches(int wheel) const;

 private:
  /// Adds the forces of the ground on a crawler's track, and the track's torque on its sprocket.
  /// `w` is the index of the sprocket's wheel.
  void push_ground_track(std::size_t w, const terramechanics::GroundQuery& ground, double dt);

  /// Scene data of the machine, which has the properties of all tyres and tracks.
  const scene::Machine& machine_;
  /// Articulated tree of the machine.
  TreeBody& tree_;
  /// Constant data and state of each wheel.
  std::vector<MachineWheel> wheels_;
};

}  // namespace navvy::vehicle
