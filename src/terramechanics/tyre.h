// SPDX-License-Identifier: Apache-2.0
// Tyre on ground: radial spring and damper, bristles limited by Coulomb friction, rolling
// resistance. Independent of any engine. On soil the limit is the soil's shear strength, mobilised
// by displacement (terramechanics/shear.h, tyre_track.h).
//
// The tread is a brush that deflects with the slip and recovers over a relaxation length sigma
// [Pacejka 2012, section 7.2]. With u the deflection, v_s the slip velocity and V the rolling
// speed:
//
//   du/dt = v_s - |V| / sigma u,     F = -k u - c v_s,     |F| <= mu N
#pragma once

#include <array>

#include "core/archive.h"
#include "core/math.h"
#include "scene/machine.h"
#include "terramechanics/ground_query.h"

namespace navvy::terramechanics {

/// State of a tyre by contact strip: the tyres of a twin pair, or two halves of a single tyre.
struct TyreState {
  /// Deflection of the bristles forward and left [m].
  std::array<Vec2, 2> bristle{Vec2::Zero(), Vec2::Zero()};
  /// Displacement by which the soil under the strip has yielded [m].
  std::array<double, 2> sheared{};

  /// Visits bristles and yielded soil. @throws InputError for a value out of range.
  void visit(Archive& a);
};

/// Motion of a wheel at the start of a step.
struct TyreMotion {
  /// Pose of the wheel: origin at the centre, y = spin axis, x forward, not spinning.
  Pose X_WWheel = Pose::Identity();
  /// Velocity of the centre [m/s].
  Vec3 v_W = Vec3::Zero();
  /// Angular velocity of the carrier, without the spin [rad/s].
  Vec3 w_W = Vec3::Zero();
  /// Spin about y relative to the carrier [rad/s].
  double spin = 0;
  /// Inertia of the wheel about y [kg m2]. Limits an explicit step.
  double spin_inertia = 10;
};

/// Force of the ground on a wheel over a step.
struct TyreForce {
  Vec3 force_W = Vec3::Zero();  ///< [N]
  /// Moment about the wheel's centre, on wheel and carrier together [N m].
  Vec3 moment_W = Vec3::Zero();
  /// Slip (rim speed - ground speed) / the larger of both [-].
  double slip = 0;
  /// Height of the ground beside the wheel above the ground under it [m].
  double sinkage = 0;
  /// Radial deflection of the deeper contact strip [m].
  double deflection = 0;

  /// Visits all fields.
  void visit(Archive& a);
};

/// Returns the grip of a tyre that presses on this ground with `pressure` [Pa]: largest tangential
/// over normal force [-]. It is the weaker of rubber friction (`scene::Wheel::friction`) and the
/// strength of the soil, tan phi + c / p with the c of its density (surface_strength). On a firm
/// floor it is the rubber's.
double tyre_friction(const scene::Wheel& tyre, const SoilState& ground, double pressure);

/// Computes the force of the ground on a wheel over the next step dt [s] and advances the bristles
/// in `state`. Reads some 80 ground heights, and the soil once per contact strip that touches.
///
/// Each contact strip is a disc that senses the ground by rays over +-60 degrees of its lower half,
/// so it also rolls over edges and steps. Longitudinal and lateral force share one limit. The force
/// never pushes the tyre off the ground faster than 0.25 m/s.
TyreForce tyre_force(const scene::Wheel& tyre, const TyreMotion& motion, const GroundQuery& ground,
                     double dt, TyreState& state);

}  // namespace navvy::terramechanics
