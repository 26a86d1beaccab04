// SPDX-License-Identifier: Apache-2.0
// Commands to machines and states of machines, as plain values. This header depends on no physics
// engine: clients of a world include only this header (and with it drive_input.h) from this module.
#pragma once

#include "core/archive.h"
#include "core/math.h"
#include "vehicle/drive/drive_input.h"

namespace navvy::vehicle {

/// Meaning of a joint's target: none (kFree, the joint swings freely), a position, a velocity, an
/// effort, or the opening of the joint's valve as set by a control lever (kOpening).
enum class JointMode { kFree, kPosition, kVelocity, kEffort, kOpening };

/// Command of one joint, which holds until it is replaced.
///
/// Position and velocity servos are limited by the joint's effort and velocity. A cylinder on the
/// joint adds its own limits: force from pressure and area, times the lever arm, and speed from its
/// flow and its share of the pump's flow.
struct JointInput {
  /// Meaning of `target`.
  JointMode mode = JointMode::kPosition;
  /// Target of the joint: a position [rad|m], a velocity [rad/s|m/s], an effort [N m|N], or a valve
  /// opening of -1 to 1, which is a share of the speed available at the current position. Not used
  /// in mode kFree.
  double target = 0;

  /// Saves, loads or hashes mode and target.
  void visit(Archive& a);
};

/// Target pose of the base link of a kinematic machine. It holds until it is replaced or until the
/// machine's drive is commanded.
struct BaseInput {
  /// Target position of the base link's origin in the world frame [m].
  Vec3 p_W = Vec3::Zero();
  /// Target orientation as roll, pitch and yaw about the fixed axes of the world frame [rad]. Roll
  /// is applied first, yaw last.
  Vec3 angles = Vec3::Zero();
  /// Duration of the motion to the target at constant velocity [s]; 0 to reach the target within
  /// one step.
  double duration = 0.1;

  /// Saves, loads or hashes the target pose and the duration.
  void visit(Archive& a);
};

/// State of a joint after the last step. The cylinder's values are 0 for a joint without a
/// cylinder.
struct JointState {
  /// Position [rad|m], velocity [rad/s|m/s] and effort that the servo applied in the last step
  /// [N m|N].
  double position = 0, velocity = 0, effort = 0;
  /// Largest effort [N m|N] and speed [rad/s|m/s] at this position, in the current direction of
  /// effort and of motion.
  double effort_limit = 0, velocity_limit = 0;
  /// Force of the joint's cylinder [N]; positive extends the cylinder. 0 without a cylinder and
  /// while the joint's brake is set.
  double cylinder_force = 0;
  /// Distance between the pins of the cylinder [m]; 0 without a cylinder.
  double cylinder_length = 0;
  /// True if the servo is at its effort limit and the joint does not move as commanded.
  bool stalled = false;
  /// True while the joint's brake is set.
  bool braked = false;
};

/// State of the pump that feeds a machine's cylinders, after the last step.
struct PumpState {
  /// Total flow of oil into the cylinders in the last step [m3/s].
  double flow = 0;
  /// Pressure of the heaviest load that the pump moves, smoothed in time [Pa].
  double pressure = 0;
};

/// State of a machine's combustion engine after the last step.
struct CombustionEngineState {
  /// Speed of the engine's shaft [rad/s]; 0 for a drive without a modelled engine.
  double speed = 0;
  /// Torque of the engine's shaft, for drive and pump together [N m].
  double torque = 0;
  /// Power of the engine, for drive and pump together [W].
  double power = 0;
  /// Engaged gear, 1-based; 0 for a drive without gears.
  int gear = 0;

  /// Saves, loads or hashes speed, torque, power and gear.
  void visit(Archive& a);
};

/// Pose and velocity of a link in the world frame. The link's frame L is the one that scene::Link
/// defines.
struct LinkState {
  /// Pose of the link's frame in the world frame.
  Pose X_WL = Pose::Identity();
  /// Velocity of the origin of the link's frame in the world frame [m/s].
  Vec3 v_WL = Vec3::Zero();
  /// Angular velocity of the link in the world frame [rad/s].
  Vec3 w_WL = Vec3::Zero();
};

/// Stability of a machine against tipping over. Its support polygon is the convex hull of the
/// points on which it stands, seen from above (vehicle/stability.h).
struct Stability {
  /// True if the machine is dynamic, has wheels and is not fixed to the world, so that it can tip.
  /// If false, the other values have no meaning.
  bool free = false;
  /// Angle of the base link's z axis from the vertical [rad].
  double tilt = 0;
  /// Rate of change of `tilt` [rad/s]; positive while it grows.
  double tilt_rate = 0;
  /// Distance of the centre of mass from the edge of the support polygon, seen from above [m];
  /// negative outside the polygon. 0 if the polygon has no area, as for the two wheels of a
  /// balancing robot: only `tilt` is useful there.
  double margin = 0;
  /// Mass [kg] that, hung on the bucket's joint in addition to all links, tips the machine over its
  /// weakest edge. kNoTippingLoad if no edge can tip; 0 for a machine that is already tipping or
  /// has no bucket.
  double tipping_load = 0;
  /// Direction in which the machine would tip over its weakest edge, as an angle from the base
  /// link's x axis, positive to the left [rad].
  double tipping_heading = 0;
  /// Distance of the centre of pressure on the ground from the edge of the support polygon,
  /// seen from above [m]; negative outside the polygon. In contrast to `margin`, it includes the
  /// effect of soil, loads and towed machines.
  double loaded_margin = 0;
};

/// Value of the tipping load [kg] that means: no load tips the machine, since the load point is
/// above the support polygon.
inline constexpr double kNoTippingLoad = 1e6;

/// Largest distance between the hook and the eye of a hitch at which the hitch can be closed [m].
inline constexpr double kHitchReach = 0.1;

/// State of a hitch between two machines after the last step.
struct HitchState {
  /// True while the hitch couples its two machines.
  bool closed = false;
  /// Distance between the eye and the hook [m].
  double apart = 0;
  /// Force of the child machine on the parent machine in the world frame [N]; 0 while the hitch is
  /// open.
  Vec3 force = Vec3::Zero();
};

/// State of a wheel or track after the last step, including its ground force. Engines without
/// forces leave forces, slip and sinkage at 0.
struct WheelState {
  /// Pose of the wheel in the world frame, without its spin: the origin is the wheel's centre, y is
  /// the spin axis, x points forward.
  Pose X_WWheel = Pose::Identity();
  /// Velocity of the wheel's centre in the world frame [m/s].
  Vec3 v_W = Vec3::Zero();
  /// Angular speed of the wheel relative to its carrier [rad/s]; positive rolls forward (+x).
  double spin = 0;
  /// Position of the wheel's steering joint [rad]; 0 without one.
  double steer = 0;
  /// Force on the tyre or track from ground and rigid bodies together in the last step, in the
  /// world frame [N].
  Vec3 force_W = Vec3::Zero();
  /// Part of `force_W` from rigid bodies, in the world frame [N]. This part presses no rut into the
  /// ground.
  Vec3 body_W = Vec3::Zero();
  /// Point in the world frame at which `body_W` acts on a track [m]; the wheel's centre for a tyre.
  Vec3 body_p_W = Vec3::Zero();
  /// Torque of the half shaft that drives the wheel in the last step [N m], including the torque
  /// that locked or limited-slip differentials transfer.
  double shaft_torque = 0;
  /// Longitudinal slip [-]: (rim speed - ground speed) / the larger magnitude of the two.
  double slip = 0;
  /// Height of the ground beside the wheel minus the height of the ground under it [m].
  double sinkage = 0;
};

}  // namespace navvy::vehicle
