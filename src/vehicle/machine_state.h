// SPDX-License-Identifier: Apache-2.0
// What a machine is told and what it answers, as plain values. No engine is named here: clients of
// a world include this header (and with it drive_input.h) and no other of the vehicle room.
#pragma once

#include "core/archive.h"
#include "core/math.h"
#include "vehicle/drive/drive_input.h"

namespace navvy::vehicle {

/// How a joint is commanded: not at all (it swings freely), to a place, at a rate, by an effort, or
/// by how far its valve is open, as a lever does it.
enum class JointMode { kFree, kPosition, kVelocity, kEffort, kOpening };

/// Command of one joint; held until replaced. Position and velocity servos are limited by effort,
/// velocity and, where a cylinder acts on the joint, by its pressure x area x lever arm, its flow
/// and its share of the pump's.
struct JointInput {
  JointMode mode = JointMode::kPosition;
  /// [rad|m], [rad/s|m/s], [N m|N], or -1 to 1: share of the speed it can have where it is.
  double target = 0;

  void visit(Archive& a);
};

/// Where the base link of a machine without masses shall be; held until replaced, and until its
/// drive is commanded.
struct BaseInput {
  Vec3 p_W = Vec3::Zero();     ///< of the base link's origin [m]
  Vec3 angles = Vec3::Zero();  ///< fixed-axis roll, pitch and yaw, yaw last [rad]
  /// It gets there evenly within this time, at once (in a step) with 0 [s].
  double duration = 0.1;

  void visit(Archive& a);
};

/// A joint as it is after the last step; of a servo without a cylinder the hydraulic part is 0.
struct JointState {
  /// Effort as applied by the servo in the last step.
  double position = 0, velocity = 0, effort = 0;
  double effort_limit = 0, velocity_limit = 0;  ///< at this position
  /// [N], 0 where no cylinder acts; positive pushes.
  double cylinder_force = 0;
  double cylinder_length = 0;  ///< [m]
  bool stalled = false;        ///< at the effort limit and not moving as told
  bool braked = false;         ///< its brake is on
};

/// The pump of a machine's cylinders.
struct PumpState {
  double flow = 0;      ///< oil that the cylinders took in the last step [m3/s]
  double pressure = 0;  ///< of the heaviest load it moves, smoothed [Pa]
};

/// What drives a machine, after the last step.
struct CombustionEngineState {
  /// Of its shaft, gears or not [rad/s]; 0 of a drive without an engine of its own.
  double speed = 0;
  double torque = 0;  ///< at its shaft, for drive and pump together [N m]
  double power = 0;   ///< for both [W]
  int gear = 0;       ///< that is in, from 1 on

  void visit(Archive& a);
};

/// Pose and velocity of a link's own frame (scene::Link), axes of W.
struct LinkState {
  Pose X_WL = Pose::Identity();
  Vec3 v_WL = Vec3::Zero();  ///< of L's origin [m/s]
  Vec3 w_WL = Vec3::Zero();  ///< [rad/s]
};

/// How a machine stands: what tells that it tips over.
struct Stability {
  /// It has wheels and masses and can tip at all; else the rest says nothing.
  bool free = false;
  double tilt = 0;       ///< of the base link's z axis from the vertical [rad]
  double tilt_rate = 0;  ///< [rad/s], positive while it grows
  /// Seen from above: how far the centre of mass is within the polygon of its feet, negative
  /// outside [m]. 0 where they span no area, as the two wheels of a robot that balances: its tilt
  /// alone tells.
  double margin = 0;
  /// Of machines with a bucket's joint: mass [kg] that tips it over its weakest edge when it hangs
  /// there besides all links; kNoTippingLoad where no edge can tip. 0 of one that tips already, and
  /// of others.
  double tipping_load = 0;
  /// Towards that edge, from x of the base link, positive to the left [rad].
  double tipping_heading = 0;
  /// As margin, of the point where the ground bears it: with soil, loads and what hangs on it [m].
  double loaded_margin = 0;
};

/// The load point stands over the feet, so that no load tips the machine [kg].
inline constexpr double kNoTippingLoad = 1e6;

/// How far the eye of a hitch may be off the hook for it to be taken [m].
inline constexpr double kHitchReach = 0.1;

/// A hitch after the last step.
struct HitchState {
  bool closed = false;
  double apart = 0;           ///< of the eye from the hook [m]
  Vec3 force = Vec3::Zero();  ///< of the child on the parent [N], axes of W
};

/// A wheel after the last step, its tyre's force included. Engines without forces leave force, slip
/// and sinkage 0.
struct WheelState {
  /// Y = spin axis, not spinning with the wheel; origin at the centre.
  Pose X_WWheel = Pose::Identity();
  Vec3 v_W = Vec3::Zero();  ///< of the centre [m/s]
  double spin = 0;          ///< [rad/s], positive rolls forward (+x)
  double steer = 0;         ///< [rad]
  /// Tyre force of the last step, ground and bodies together [N].
  Vec3 force_W = Vec3::Zero();
  Vec3 body_W = Vec3::Zero();    ///< what bodies gave of it: it presses no rut [N]
  Vec3 body_p_W = Vec3::Zero();  ///< the middle of that, on a belt [m]
  /// Of the drive's half shaft in the last step, differentials included [N m].
  double shaft_torque = 0;
  double slip = 0;     ///< longitudinal [-]
  double sinkage = 0;  ///< [m]
};

}  // namespace navvy::vehicle
