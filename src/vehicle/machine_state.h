// SPDX-License-Identifier: Apache-2.0
// Commands to machines and their state, as plain values. Names no physics engine: clients of a
// world include this header (and with it drive_input.h) and no other of this module.
#pragma once

#include "core/archive.h"
#include "core/math.h"
#include "vehicle/drive/drive_input.h"

namespace navvy::vehicle {

/// Selects what a joint's target is: nothing (it swings freely), a position, a velocity, an effort,
/// or the opening of its valve as a lever sets it.
enum class JointMode { kFree, kPosition, kVelocity, kEffort, kOpening };

/// Command of one joint; held until replaced. Position and velocity servos are limited by effort,
/// velocity and, where a cylinder acts on the joint, by its pressure x area x lever arm, its flow
/// and its share of the pump's flow.
struct JointInput {
  JointMode mode = JointMode::kPosition;
  /// Target [rad|m], [rad/s|m/s], [N m|N], or -1 to 1 for an opening: share of the speed available
  /// at the present position.
  double target = 0;

  /// Visits mode and target.
  void visit(Archive& a);
};

/// Target pose of the base link of a kinematic machine; held until replaced or until its drive is
/// commanded.
struct BaseInput {
  /// Position of the base link's origin [m].
  Vec3 p_W = Vec3::Zero();
  /// Fixed-axis roll, pitch and yaw, yaw last [rad].
  Vec3 angles = Vec3::Zero();
  /// Duration of the motion at constant velocity [s]; 0: within one step.
  double duration = 0.1;

  /// Visits the target pose and the duration.
  void visit(Archive& a);
};

/// State of a joint after the last step. The hydraulic part is 0 for a servo without a cylinder.
struct JointState {
  /// Position [rad|m], velocity [rad/s|m/s] and the effort that the servo applied [N m|N].
  double position = 0, velocity = 0, effort = 0;
  /// Limits at this position.
  double effort_limit = 0, velocity_limit = 0;
  /// Force of the cylinder [N], 0 without one; positive extends it.
  double cylinder_force = 0;
  /// Length of the cylinder [m].
  double cylinder_length = 0;
  /// True at the effort limit if the joint does not move as commanded.
  bool stalled = false;
  /// The brake is set.
  bool braked = false;
};

/// State of the pump that feeds a machine's cylinders.
struct PumpState {
  /// Oil flow into the cylinders in the last step [m3/s].
  double flow = 0;
  /// Pressure of the heaviest load that the pump moves, smoothed [Pa].
  double pressure = 0;
};

/// State of a machine's combustion engine after the last step.
struct CombustionEngineState {
  /// Shaft speed, with or without gears [rad/s]; 0 for a drive without an engine of its own.
  double speed = 0;
  /// Shaft torque, for drive and pump together [N m].
  double torque = 0;
  /// Power for both [W].
  double power = 0;
  /// Engaged gear, 1-based.
  int gear = 0;

  /// Visits speed, torque, power and gear.
  void visit(Archive& a);
};

/// Pose and velocity of a link's frame L (scene::Link), axes of W.
struct LinkState {
  Pose X_WL = Pose::Identity();
  /// Velocity of L's origin [m/s].
  Vec3 v_WL = Vec3::Zero();
  /// Angular velocity [rad/s].
  Vec3 w_WL = Vec3::Zero();
};

/// Stability of a machine against tipping over.
struct Stability {
  /// The machine is dynamic, has wheels and can tip. If false, the other values are meaningless.
  bool free = false;
  /// Angle of the base link's z axis from the vertical [rad].
  double tilt = 0;
  /// Rate of the tilt [rad/s], positive while it grows.
  double tilt_rate = 0;
  /// Distance of the centre of mass, seen from above, inside the polygon of the feet; negative
  /// outside [m]. 0 if the feet span no area, as for the two wheels of a balancing robot: only the
  /// tilt counts there.
  double margin = 0;
  /// Mass [kg] at the bucket's joint that tips the machine over its weakest edge, in addition to
  /// all links. kNoTippingLoad if no edge can tip; 0 for a machine that is tipping already, or has
  /// no bucket.
  double tipping_load = 0;
  /// Direction of that edge, from x of the base link, positive to the left [rad].
  double tipping_heading = 0;
  /// Same as `margin`, for the centre of pressure on the ground: with soil, loads and towed
  /// machines [m].
  double loaded_margin = 0;
};

/// Tipping load if the load point is over the feet, so that no load tips the machine [kg].
inline constexpr double kNoTippingLoad = 1e6;

/// Largest distance of the eye from the hook at which a hitch closes [m].
inline constexpr double kHitchReach = 0.1;

/// State of a hitch after the last step.
struct HitchState {
  bool closed = false;
  /// Distance of the eye from the hook [m].
  double apart = 0;
  /// Force of the child on the parent [N], axes of W.
  Vec3 force = Vec3::Zero();
};

/// State of a wheel after the last step, tyre force included. Engines without forces leave force,
/// slip and sinkage 0.
struct WheelState {
  /// Pose with the origin at the centre and y along the spin axis, not spinning with the wheel.
  Pose X_WWheel = Pose::Identity();
  /// Velocity of the centre [m/s].
  Vec3 v_W = Vec3::Zero();
  /// Spin [rad/s]; positive rolls forward (+x).
  double spin = 0;
  double steer = 0;  ///< [rad]
  /// Tyre force of the last step, from ground and bodies together [N].
  Vec3 force_W = Vec3::Zero();
  /// Part of the force from bodies, which presses no rut [N].
  Vec3 body_W = Vec3::Zero();
  /// Point of application of that part on a track [m].
  Vec3 body_p_W = Vec3::Zero();
  /// Torque of the drive's half shaft in the last step, differentials included [N m].
  double shaft_torque = 0;
  /// Longitudinal slip [-].
  double slip = 0;
  double sinkage = 0;  ///< [m]
};

}  // namespace navvy::vehicle
