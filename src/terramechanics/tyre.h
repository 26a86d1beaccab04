// SPDX-License-Identifier: Apache-2.0
// Tyre on ground: radial spring and damper, bristles with Coulomb's limit, rolling resistance.
// Knows no engine. On soil the limit is the soil's shear strength, mobilised by displacement
// (terramechanics/shear.h, tyre_track.h).
//
// Bristles: the tread is a brush that stretches by the slip and rolls out again over a relaxation
// length sigma [Pacejka 2012, section 7.2]. With u the stretch, v_s the slip velocity and V the
// rolling speed:
//
//   du/dt = v_s - |V| / sigma u,     F = -k u - c v_s,     |F| <= mu N
#pragma once

#include <array>

#include "core/archive.h"
#include "core/math.h"
#include "scene/machine.h"
#include "terramechanics/ground_query.h"

namespace navvy::terramechanics {

/// All the memory a tyre has, by track (the tyres of a twin pair, or two halves of a single tyre).
struct TyreState {
  std::array<Vec2, 2> bristle{Vec2::Zero(), Vec2::Zero()};  ///< deflection forward and left [m]
  /// How far soil under it has yielded [m].
  std::array<double, 2> sheared{};

  void visit(Archive& a);
};

/// How a wheel moves at the start of a step.
struct TyreMotion {
  /// Origin at the centre, y = spin axis, x forward, not spinning.
  Pose X_WWheel = Pose::Identity();
  Vec3 v_W = Vec3::Zero();  ///< of the centre [m/s]
  Vec3 w_W = Vec3::Zero();  ///< of the carrier, without the spin [rad/s]
  double spin = 0;          ///< about y relative to the carrier [rad/s]
  /// Of the wheel about y [kg m2]; bounds what an explicit step may do.
  double spin_inertia = 10;
};

/// What the ground does to it over the step.
struct TyreForce {
  Vec3 force_W = Vec3::Zero();   ///< [N]
  Vec3 moment_W = Vec3::Zero();  ///< about the wheel's centre, on wheel and carrier together [N m]
  double slip = 0;               ///< (rim speed - ground speed) / the larger of both [-]
  double sinkage = 0;            ///< ground beside the wheel above the ground under it [m]
  double deflection = 0;         ///< radial, of the deeper track [m]

  void visit(Archive& a);
};

/// Grip of a tyre that presses with `pressure` [Pa] on this ground: largest tangential over normal
/// force [-]. The one place that decides it. The weaker of rubber on what it stands on
/// (`scene::Wheel::friction`) and the soil itself, tan phi + c / p with c of its density state
/// (surface_strength); on a firm floor the rubber's.
double tyre_friction(const scene::Wheel& tyre, const SoilState& ground, double pressure);

/// Force of the ground on a wheel over the next step dt [s]; moves the bristles. Reads about 80
/// ground heights and asks for the soil once a track that touches.
///
/// Each track is a disc that feels the ground by rays over +-60 degrees of its lower half, so edges
/// and steps carry it as well as planes. Force ahead and to the side share one limit. A tyre's
/// force never pushes it off the ground faster than 0.25 m/s, whatever the ground does under it.
TyreForce tyre_force(const scene::Wheel& tyre, const TyreMotion& motion, const GroundQuery& ground,
                     double dt, TyreState& state);

}  // namespace navvy::terramechanics
