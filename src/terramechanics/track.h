// SPDX-License-Identifier: Apache-2.0
// The belt of a crawler on ground: rollers press it down, soil shears along its length. Knows no
// engine.
//
// Each roller presses one segment of the lower run, p = N / (b l). Shoes enter at the end the
// machine moves to and come out at the other one; on the way the soil under them is sheared by j,
// and resists by [Janosi 1961]
//
//   tau = (c + p tan phi) (1 - exp(-|j| / K)),    dj/dt = v_s - V dj/ds
//
// V speed of the belt on its rollers [m/s], v_s slip of the shoes over the ground (ahead, left), s
// along the belt from where the shoes come in. On a firm floor c = 0, tan phi is the belt's
// friction, and K its own give [docs/machines.md, tracks].
#pragma once

#include <vector>

#include "core/archive.h"
#include "core/math.h"
#include "scene/machine.h"
#include "terramechanics/ground_query.h"
#include "terramechanics/shear.h"

namespace navvy::terramechanics {

/// One wheel of the running gear over the ground: what it bears, and how far the soil under it is
/// sheared where the shoes leave it (ahead, left) [m].
struct TrackContact {
  double load = 0;  ///< of the last step [N]
  Vec2 shear = Vec2::Zero();

  void visit(Archive& a);
};

/// All the memory a belt has: idler, rollers and sprocket in the order from front to rear.
struct TrackState {
  std::vector<TrackContact> contacts;

  /// At rest on nothing.
  static TrackState of(const scene::Track& track);
};

/// How a belt moves at the start of a step.
struct TrackMotion {
  Pose X_WC = Pose::Identity();    ///< of the link that carries it
  Vec3 v_W = Vec3::Zero();         ///< of that link's origin [m/s]
  Vec3 w_W = Vec3::Zero();         ///< [rad/s]
  Vec3 p_sprocket = Vec3::Zero();  ///< middle of the sprocket in that link [m]
  double spin = 0;                 ///< of the sprocket, positive rolls forward [rad/s]
  /// Of sprocket, idler and belt, at the sprocket [kg m2]; bounds an explicit step.
  double spin_inertia = 10;
};

/// A rectangle on which the belt presses.
struct TrackPatch {
  Vec3 p_W = Vec3::Zero();       ///< its middle [m]
  Vec3 ahead_W = Vec3::UnitX();  ///< unit, along the belt
  double length = 0, width = 0;  ///< [m]
  double load = 0;               ///< [N]
};

/// What the ground does to it over the step.
struct TrackForce {
  struct Push {
    Vec3 f_W = Vec3::Zero();  ///< [N]
    Vec3 p_W = Vec3::Zero();  ///< where, on the belt [m]
  };
  std::vector<Push> pushes;     ///< on the link that carries it
  double torque = 0;            ///< of the belt on its sprocket, against the carrier [N m]
  Vec3 force_W = Vec3::Zero();  ///< sum of the pushes [N]
  double slip = 0;              ///< (V - ground speed) / the larger of both [-]
  double sinkage = 0;           ///< ground beside the belt above the ground under it [m]
};

/// What a shoe with grousers shears at on this ground: the soil's own c and phi, of which cohesion
/// goes over from the intact to the remoulded one as the soil lies looser; a firm floor by the
/// belt's friction alone.
ShearStrength track_strength(const scene::Wheel& wheel, const SoilState& ground);

/// Force of the ground on the belt of `wheel` (which has a track) over the next step dt [s]; moves
/// the shear on. Reads about a dozen ground heights and asks for the soil once a contact.
///
/// Rollers press along the normal of a firm floor, and along the belt's in soil, which is pressed
/// flat under it; idler and sprocket press where they meet ground ahead and behind. The belt has no
/// width for the load, only for the soil: it bears on its middle line.
TrackForce track_force(const scene::Wheel& wheel, const TrackMotion& motion,
                       const GroundQuery& ground, double dt, TrackState& state);

/// Where it presses, with the loads of the last step; contacts in the air are left out.
std::vector<TrackPatch> track_patches(const scene::Wheel& wheel, const TrackMotion& motion,
                                      const TrackState& state);

}  // namespace navvy::terramechanics
