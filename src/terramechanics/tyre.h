// SPDX-License-Identifier: Apache-2.0
// Force of the ground on a tyre: a radial spring and damper, tread bristles limited by Coulomb
// friction, and rolling resistance. On soil, the limit is the soil's shear strength, which shear
// displacement mobilises (shear.h, tyre_strip.h). Independent of the physics engine.
//
// The tread is a brush that deflects with the slip and recovers over a relaxation length sigma
// [Pacejka 2012, section 7.2]. u is its deflection, v_s the slip velocity, V the rolling speed, N
// the normal force, k and c the stiffness and damping of the bristles:
//
//   du/dt = v_s - |V| / sigma u,     F = -k u - c v_s,     |F| <= mu N
#pragma once

#include <array>

#include "core/archive.h"
#include "core/math.h"
#include "scene/machine.h"
#include "terramechanics/ground_query.h"

namespace navvy::terramechanics {

/// State of a tyre between two steps. Both arrays have one entry per contact strip, left then
/// right: the two tyres of a twin pair, or the two halves of a single tyre.
struct TyreState {
  /// Deflection of the tread's bristles (forward, left) [m].
  std::array<Vec2, 2> bristle{Vec2::Zero(), Vec2::Zero()};
  /// Shear displacement by which the soil under the strip has yielded [m], >= 0.
  std::array<double, 2> sheared{};

  /// Saves, loads or hashes the bristle deflections and the soil's shear displacements.
  /// @throws InputError for a value out of range.
  void visit(Archive& a);
};

/// Motion of a wheel at the start of a step. The carrier is the link on which the wheel spins.
struct TyreMotion {
  /// Pose of the wheel in the world frame, without its spin: the origin is the wheel's centre, y is
  /// the spin axis, x points forward.
  Pose X_WWheel = Pose::Identity();
  /// Velocity of the wheel's centre in the world frame [m/s].
  Vec3 v_W = Vec3::Zero();
  /// Angular velocity of the carrier, the link on which the wheel spins, in the world frame
  /// [rad/s]. It does not include the wheel's spin.
  Vec3 w_W = Vec3::Zero();
  /// Angular speed of the wheel about its axle relative to the carrier link [rad/s]; positive rolls
  /// forward.
  double spin = 0;
  /// Inertia of the wheel about its axle [kg m2]. It limits forces so that an explicit time step
  /// remains stable.
  double spin_inertia = 10;
};

/// Force of the ground on a wheel over one step.
struct TyreForce {
  /// Force on the wheel in the world frame [N].
  Vec3 force_W = Vec3::Zero();
  /// Moment of the ground's force about the wheel's centre in the world frame [N m]. It acts on the
  /// wheel and, through the axle, on the carrier link.
  Vec3 moment_W = Vec3::Zero();
  /// Longitudinal slip [-]: (rim speed - ground speed) / the larger magnitude of the two.
  double slip = 0;
  /// Depth of the rut [m]: height of the ground beside the wheel minus the height of the ground
  /// under it.
  double sinkage = 0;
  /// Radial deflection of the more deflected of the two contact strips [m].
  double deflection = 0;

  /// Saves, loads or hashes all fields.
  void visit(Archive& a);
};

/// Returns the friction coefficient [-] of a tyre that presses on `ground` with `pressure` [Pa]:
/// its largest tangential force divided by its normal force.
///
/// The coefficient is the smaller of the rubber's (scene::Wheel::friction) and the soil's, tan phi
/// + c / p, with the cohesion c of surface_strength(). On a firm floor it is the rubber's.
double tyre_friction(const scene::Wheel& tyre, const SoilState& ground, double pressure);

/// Returns the force of `ground` on a wheel over the next step `dt` [s], and advances the bristles
/// and the soil's shear in `state`. Costs about 80 height queries, and one soil query per contact
/// strip that touches.
///
/// Each contact strip is a disc that senses the ground along rays within 60 degrees of its downward
/// direction, so it also rolls over edges and steps. Longitudinal and lateral force together are
/// limited by friction. The normal force vanishes where the tyre moves away from the ground faster
/// than 0.25 m/s.
TyreForce tyre_force(const scene::Wheel& tyre, const TyreMotion& motion, const GroundQuery& ground,
                     double dt, TyreState& state);

}  // namespace navvy::terramechanics
