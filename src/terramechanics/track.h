// SPDX-License-Identifier: Apache-2.0
// Forces of the ground on a crawler's track: rollers press it down, soil shears along its length.
// Independent of the physics engine.
//
// Each roller presses one segment of the lower run with the pressure p = N / (b l), its load N
// divided by the segment's area. Shoes enter the lower run at its leading end and leave it at its
// trailing end. In between, they shear the soil by the displacement j, and the soil resists with
// the stress [Janosi 1961]
//
//   tau = (c + p tan phi) (1 - exp(-|j| / K)),    dj/dt = v_s - V dj/ds
//
// V is the speed of the track over its rollers [m/s], v_s the slip velocity of the shoes over the
// ground (forward, left), and s the distance along the track from the leading end. On a firm floor,
// c is 0, tan phi is the track's friction coefficient, and K is the compliance of the track itself
// [docs/machines.md, tracks].
#pragma once

#include <vector>

#include "core/archive.h"
#include "core/math.h"
#include "scene/machine.h"
#include "terramechanics/ground_query.h"
#include "terramechanics/shear.h"

namespace navvy::terramechanics {

/// Contact of one wheel of a track's running gear (idler, roller or sprocket) with the ground.
struct TrackContact {
  /// Normal force of the ground on this wheel in the last step [N]; 0 without contact.
  double load = 0;
  /// Shear displacement (forward, left) of the soil where shoes leave the segment of track under
  /// this wheel [m].
  Vec2 shear = Vec2::Zero();

  /// Saves, loads or hashes load and shear.
  /// @throws InputError for a shear that is not finite.
  void visit(Archive& a);
};

/// State of a crawler's track between two steps.
struct TrackState {
  /// One contact per wheel of the running gear, from front to rear: idler or sprocket (whichever is
  /// ahead), all rollers, then the other one.
  std::vector<TrackContact> contacts;

  /// Returns the initial state for `track`: one contact per wheel, all without load and shear.
  static TrackState of(const scene::Track& track);
};

/// Motion of a track at the start of a step. The carrier is the link on which the running gear is
/// mounted, with frame C.
struct TrackMotion {
  /// Pose of the carrier link, on which the track's running gear is mounted, in the world frame.
  Pose X_WC = Pose::Identity();
  /// Velocity of the origin of the track's carrier link in the world frame [m/s].
  Vec3 v_W = Vec3::Zero();
  /// Angular velocity of the track's carrier link in the world frame [rad/s].
  Vec3 w_W = Vec3::Zero();
  /// Centre of the sprocket in the frame C of the track's carrier link [m].
  Vec3 p_sprocket = Vec3::Zero();
  /// Angular speed of the sprocket relative to the track's carrier link [rad/s]; positive rolls
  /// forward.
  double spin = 0;
  /// Inertia of sprocket, idler and track, reduced to the sprocket's axis [kg m2]. It limits forces
  /// so that an explicit time step remains stable.
  double spin_inertia = 10;
};

/// Rectangle of ground on which one wheel of the running gear presses the track.
struct TrackPatch {
  /// Centre of the rectangle in the world frame [m].
  Vec3 p_W = Vec3::Zero();
  /// Unit vector along the track in the world frame, forward.
  Vec3 ahead_W = Vec3::UnitX();
  /// Side along `ahead_W`, and side across it, which is the width of the track [m].
  double length = 0, width = 0;
  /// Normal force on the rectangle in the last step [N].
  double load = 0;
};

/// Force of the ground on a track over one step.
struct TrackForce {
  /// Force on the carrier of the track at one point.
  struct Push {
    /// Force of the ground in the world frame [N].
    Vec3 f_W = Vec3::Zero();
    /// Point of application in the world frame [m], on the outside of the track.
    Vec3 p_W = Vec3::Zero();
  };
  /// Forces of the ground on the track's carrier link: one per loaded contact, then the resistance
  /// of the soil ahead of the track, if there is any.
  std::vector<Push> pushes;
  /// Torque of the track on its sprocket, about the sprocket's axis [N m]; positive drives the
  /// sprocket forward. The opposite torque acts on the carrier link.
  double torque = 0;
  /// Sum of all `pushes` in the world frame [N].
  Vec3 force_W = Vec3::Zero();
  /// Slip of the track [-]: (track speed - ground speed) / the larger magnitude of the two.
  double slip = 0;
  /// Depth of the track's rut [m]: height of the ground beside the track minus the height of the
  /// ground under it, averaged by load.
  double sinkage = 0;
};

/// Returns the shear strength of `ground` under a shoe with grousers. Soil has its own c and phi;
/// its cohesion falls from the intact to the loose value as the soil swells (surface_strength). On
/// a firm floor only the track's friction coefficient, wheel.friction, counts.
ShearStrength track_strength(const scene::Wheel& wheel, const SoilState& ground);

/// Returns the force of `ground` on the track of the sprocket `wheel` over the next step `dt` [s]
/// and advances the loads and shears in `state`.
///
/// Precondition: `wheel` has a track. Costs about 12 height queries, and one soil query per
/// contact.
///
/// On a firm floor, rollers press along the floor's normal. In soil they press along the track's
/// normal, since the track flattens the soil under it. Idler and sprocket press where they meet
/// ground ahead of or behind the rollers. Heights are read only on the track's centre line; the
/// width of the track affects only the forces in soil.
TrackForce track_force(const scene::Wheel& wheel, const TrackMotion& motion,
                       const GroundQuery& ground, double dt, TrackState& state);

/// Returns the rectangles on which the track of the sprocket `wheel` presses at the current pose,
/// with the loads of the last step. Contacts without load are left out.
std::vector<TrackPatch> track_patches(const scene::Wheel& wheel, const TrackMotion& motion,
                                      const TrackState& state);

}  // namespace navvy::terramechanics
