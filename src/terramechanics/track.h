// SPDX-License-Identifier: Apache-2.0
// Forces of the ground on a crawler's track: rollers press it down, soil shears along its length.
// Independent of any engine.
//
// Each roller presses one segment of the lower run, p = N / (b l). Shoes enter at the leading end
// and leave at the trailing end. On the way the soil under them is sheared by j and resists with
// [Janosi 1961]
//
//   tau = (c + p tan phi) (1 - exp(-|j| / K)),    dj/dt = v_s - V dj/ds
//
// V is the speed of the track on its rollers [m/s], v_s the slip velocity of the shoes over the
// ground (ahead, left), s the position along the track from where shoes enter. On a firm floor c =
// 0, tan phi is the track's friction and K its own compliance [docs/machines.md, tracks].
#pragma once

#include <vector>

#include "core/archive.h"
#include "core/math.h"
#include "scene/machine.h"
#include "terramechanics/ground_query.h"
#include "terramechanics/shear.h"

namespace navvy::terramechanics {

/// State of one wheel of the running gear on the ground.
struct TrackContact {
  /// Load in the last step [N].
  double load = 0;
  Vec2 shear = Vec2::Zero();

  /// Visits load and shear. @throws InputError for a shear that is not finite.
  void visit(Archive& a);
};

/// State of a track: one contact for idler, rollers and sprocket, from front to rear.
struct TrackState {
  std::vector<TrackContact> contacts;

  /// Returns the state of a track without load and shear.
  static TrackState of(const scene::Track& track);
};

/// Motion of a track at the start of a step.
struct TrackMotion {
  /// Pose of the carrier C, the link that carries the track.
  Pose X_WC = Pose::Identity();
  /// Velocity of the carrier's origin [m/s].
  Vec3 v_W = Vec3::Zero();
  /// Angular velocity of the carrier [rad/s].
  Vec3 w_W = Vec3::Zero();
  /// Centre of the sprocket in C [m].
  Vec3 p_sprocket = Vec3::Zero();
  /// Speed of the sprocket [rad/s]; positive rolls forward.
  double spin = 0;
  /// Inertia of sprocket, idler and track at the sprocket [kg m2]. Limits an explicit step.
  double spin_inertia = 10;
};

/// Rectangle on which the track presses.
struct TrackPatch {
  /// Centre [m].
  Vec3 p_W = Vec3::Zero();
  /// Unit vector along the track.
  Vec3 ahead_W = Vec3::UnitX();
  double length = 0, width = 0;  ///< [m]
  double load = 0;               ///< [N]
};

/// Force of the ground on a track over a step.
struct TrackForce {
  /// Force on the track at one point.
  struct Push {
    Vec3 f_W = Vec3::Zero();  ///< [N]
    /// Point of application on the track [m].
    Vec3 p_W = Vec3::Zero();
  };
  /// Forces on the carrier.
  std::vector<Push> pushes;
  /// Torque of the track on its sprocket, against the carrier [N m].
  double torque = 0;
  /// Sum of the pushes [N].
  Vec3 force_W = Vec3::Zero();
  /// Slip (V - ground speed) / the larger of both [-].
  double slip = 0;
  /// Height of the ground beside the track above the ground under it [m].
  double sinkage = 0;
};

/// Returns the shear strength of the ground under a shoe with grousers. Soil has its own c and phi;
/// cohesion goes from the intact to the remoulded value as the soil gets looser. A firm floor has
/// the friction of the track alone.
ShearStrength track_strength(const scene::Wheel& wheel, const SoilState& ground);

/// Computes the force of the ground on the track of `wheel` (which has one) over the next step dt
/// [s] and advances the shear in `state`. Reads some 12 ground heights, and the soil once per
/// contact.
///
/// Rollers press along the normal of a firm floor. In soil they press along the track's normal,
/// since the track flattens the soil under it. Idler and sprocket press where they meet ground
/// ahead and behind. Heights are read on the middle line alone; the width counts for the soil only.
TrackForce track_force(const scene::Wheel& wheel, const TrackMotion& motion,
                       const GroundQuery& ground, double dt, TrackState& state);

/// Returns the rectangles on which the track presses, with the loads of the last step. Contacts
/// without load are left out.
std::vector<TrackPatch> track_patches(const scene::Wheel& wheel, const TrackMotion& motion,
                                      const TrackState& state);

}  // namespace navvy::terramechanics
